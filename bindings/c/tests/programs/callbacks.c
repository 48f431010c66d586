/* Callbacks that use their own check: an error of the check, no harm to it, and nothing is lost. Texts that were read
 * stay where they are. */
#include <stdio.h>
#include <string.h>

#include "trueflight.h"

static tf_check *check;
static int calls, inner;

static double plain(tf_rng *rng, void *user)
{
    (void)user;
    return tf_rng_uniform(rng);
}

static double draws_again(tf_rng *rng, void *user)
{
    ++calls;
    inner = tf_check_run(check, plain, NULL);
    return plain(rng, user);
}

static double says(tf_rng *rng, void *user)
{
    ++calls;
    inner = TF_SET(check, TF_ALPHA, 0.01);
    return plain(rng, user);
}

static double frees(tf_rng *rng, void *user)
{
    ++calls;
    tf_check_free(check);
    return plain(rng, user);
}

static double looks(tf_rng *rng, void *user)
{
    tf_verdict verdict;
    ++calls;
    inner = tf_check_verdict(check, &verdict) + tf_check_passed(check) + tf_check_is_open(check);
    return plain(rng, user) + (tf_check_text(check) != tf_last_error());
}

static double other(tf_rng *rng, void *user)
{
    if (calls++ == 0) {
        tf_check *own = tf_check_new("other");
        TF_SET(own, TF_TRUTH, 0.5);
        inner = tf_check_run(own, plain, NULL);
        tf_check_free(own);
    }
    return plain(rng, user);
}

static void told(const char *what, tf_draw_function draw)
{
    check = tf_check_new("half");
    TF_SET(check, TF_TRUTH, 0.5);
    TF_SET(check, TF_RANGE, 0, 1);
    calls = inner = 0;
    const tf_status status = tf_check_run(check, draw, NULL);
    const int passed = tf_check_passed(check);
    printf("%s: %d, %d, one block: %d, passed: %d\n", what, inner, (int)status, calls == 1 << 14, passed);
    if (status) printf("%s says: %s\n", what, tf_check_text(check));
    tf_check_free(check);
}

int main(void)
{
    told("draws", draws_again);
    told("says", says);
    told("frees", frees);
    told("looks", looks);
    told("other", other);

    /* The last error has one place: no order of evaluation reads what was freed. */
    const char *place = tf_last_error();
    tf_status status;
    tf_verdict verdict;
    for (int i = 0; i < 3; ++i) {
        check = tf_check_new("half");
        tf_check_of(check, "nope", "x", NAN);
        printf("place: %d %s\n", (int)(status = tf_check_verdict(check, &verdict)), tf_last_error());
        if (status != TF_STATUS_CASE || place != tf_last_error()) return 1;
        tf_check_free(check);
    }
    /* A long one is cut, and the check has all of it. */
    static char name[20001];
    memset(name, 'x', 20000);
    for (int i = 1; i < 20000; i += 2) memcpy(name + i - 1, "\xc3\xa9", 2);
    check = tf_check_new(name);
    TF_SET(check, TF_DRAWS, -1);
    printf("long: %d, %d\n", (int)strlen(tf_last_error()), strlen(tf_check_text(check)) > 20000);
    tf_check_free(check);

    /* A text is valid until the check is freed, whatever goes wrong after it. */
    check = tf_check_new("half");
    TF_SET(check, TF_TRUTH, 0.5);
    TF_SET(check, TF_RANGE, 0, 1);
    tf_check_run(check, plain, NULL);
    const char *text = tf_check_text(check), *reason = tf_check_reason(check);
    TF_SET(check, TF_ALPHA, 0.01);
    printf("text: %.12s, %d, %.20s\n", text, reason[0], tf_check_text(check));
    tf_check_free(check);
    return 0;
}
