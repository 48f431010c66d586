/* How many values a draw has is said by the call that draws, not by what is claimed. */
#include <stdio.h>

#include "trueflight.h"

/* As many as the pointer says. */
static size_t fill(double *out, size_t draws, tf_rng *rng, void *values)
{
    const size_t count = draws * *(const size_t *)values;
    for (size_t i = 0; i < count; ++i) out[i] = tf_rng_uniform(rng);
    return draws;
}

static double one(tf_rng *rng, void *user)
{
    (void)user;
    return tf_rng_uniform(rng);
}

static void told(const char *what, tf_status status)
{
    printf("%s: %d %s\n", what, (int)status, status ? tf_last_error() : "");
}

static tf_check *claimed(size_t truths)
{
    const double list[3] = {0.5, 0.5, 0.5};
    tf_check *check = tf_check_new("uniform");
    if (truths == 1) TF_SET(check, TF_TRUTH, 0.5);
    else tf_check_set(check, TF_TRUTH, list, truths);
    TF_SET(check, TF_RANGE, 0, 1);
    return check;
}

int main(void)
{
    size_t two = 2, three = 3;
    tf_check *check = claimed(1);
    /* Asking does not fix the number of values. */
    printf("wanted: %d\n", tf_check_is_open(check));
    told("one truth", tf_check_run_batches(check, 3, fill, &three));
    const size_t values = tf_check_values(check);
    printf("values: %d, passed: %d\n", (int)values, tf_check_passed(check));
    tf_check_free(check);

    check = claimed(3);
    told("three truths", tf_check_run_batches(check, 3, fill, &three));
    tf_check_free(check);

    check = claimed(3);
    told("two of three", tf_check_run_batches(check, 2, fill, &two));
    tf_check_free(check);

    check = claimed(3);
    told("one of three", tf_check_run(check, one, NULL));
    tf_check_free(check);

    check = claimed(1);
    const double draw = 0.5;
    tf_check_absorb(check, &draw, 1);
    told("two after one", tf_check_run_batches(check, 2, fill, &two));
    tf_check_free(check);

    check = claimed(1);
    told("none", tf_check_run_batches(check, 0, fill, &two));
    tf_check_free(check);

    check = claimed(1);
    told("most", tf_check_run_batches(check, (size_t)-1, fill, &two));
    tf_check_free(check);

    check = claimed(1);
    told("many", tf_check_run_batches(check, (size_t)1 << 48, fill, &two));
    tf_check_free(check);
    return 0;
}
