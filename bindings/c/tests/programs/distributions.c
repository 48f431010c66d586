/* Flights, lookups and channels against a case: each line is what a verdict says. The folder of the inputs is the first
 * argument. */
#include <stdio.h>
#include <stdlib.h>

#include "trueflight.h"

#define COUNT 100000

static double flight(tf_rng *rng)
{
    const double depth = -log(tf_rng_positive_uniform(rng));
    return depth < 0.5 ? depth / 0.5 : 1 + (depth - 0.5) / 2;
}

static void say(const char *what, tf_check *check)
{
    tf_verdict verdict;
    if (tf_check_verdict(check, &verdict) != TF_STATUS_OK) {
        printf("%s: %s\n", what, tf_last_error());
    } else {
        printf("%s: %d %s\n", what, (int)verdict, tf_check_reason(check));
    }
    tf_check_free(check);
}

static void flights(const char *what, const char *path, double left, int two)
{
    double *draws = malloc(COUNT * sizeof *draws);
    tf_rng rng = {{1, 2, 3, 4}};
    for (size_t i = 0; draws && i < COUNT; ++i) {
        const double t = flight(&rng);
        draws[i] = two ? (tf_rng_uniform(&rng) < 0.5 ? 0.4786567 : 1.6196663) : t < 2 ? t : left;
    }
    tf_check *check = tf_check_new(what);
    tf_check_of(check, path, "woodcock", NAN);
    tf_check_absorb(check, draws, COUNT);
    free(draws);
    say(what, check);
}

int main(int count, char **arguments)
{
    char path[4096];
    if (count < 2) return 2;
    snprintf(path, sizeof path, "%s/13-free-flight-law/ff.toml", arguments[1]);
    flights("length", path, 2, 0);
    flights("beyond", path, 1e30, 0);
    flights("inf", path, INFINITY, 0);
    flights("minus one", path, -1, 0);
    flights("zero", path, 0, 0);
    flights("two lengths", path, 2, 1);

    /* Channels of a draw, one draw after the other, without their luminance. */
    snprintf(path, sizeof path, "%s/03-channels-in-one-file/three.toml", arguments[1]);
    const double draws[12] = {1, 0, 0, 0, 0, 0, 1, 1, 0, 0, 1, 0};
    tf_check *check = tf_check_new("channels");
    tf_check_of(check, path, "spectral-mis", NAN);
    TF_SET(check, TF_VALUES, 3);
    tf_check_absorb(check, draws, 12);
    tf_numbers found;
    const tf_status status = tf_check_numbers(check, 2, &found);
    printf("channels: %d, %zu values, %d draws\n", (int)status, tf_check_values(check), (int)found.draws);
    tf_check_free(check);
    check = tf_check_new("no values");
    tf_check_of(check, path, "spectral-mis", NAN);
    printf("no values: %d ", (int)TF_SET(check, TF_VALUES, 0));
    printf("%s\n", tf_last_error());
    tf_check_free(check);
    check = tf_check_new("two");
    tf_check_of(check, path, "spectral-mis", NAN);
    TF_SET(check, TF_VALUES, 2);
    tf_check_absorb(check, draws, 12);
    printf("two: %s\n", tf_last_error());
    tf_check_free(check);
    return 0;
}
