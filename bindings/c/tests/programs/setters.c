/* What a setter is given and makes no sense: its own error, which a later good value does not undo. */
#include <stdio.h>
#include <string.h>

#include "trueflight.h"

static int wrong = 0;

/* A mistake and a good value: the code of both, and the message. */
static void told(const char *what, tf_check *check, tf_status bad, tf_status good)
{
    tf_verdict verdict;
    const tf_status later = tf_check_verdict(check, &verdict);
    printf("%s: %d %s\n", what, (int)bad, tf_last_error());
    if (bad != later || bad != good || strcmp(tf_check_text(check), tf_last_error()) != 0) ++wrong;
    tf_check_free(check);
}

#define TOLD(WHAT, BAD, GOOD)                      \
    do {                                           \
        tf_check *c = tf_check_new(WHAT);          \
        const tf_status bad = BAD, good = GOOD;    \
        told(WHAT, c, bad, good);                  \
    } while (0)

int main(void)
{
    const double list[2] = {0.5, NAN}, fine[2] = {0.5, 0.5};
    TOLD("alpha", tf_check_alpha(c, -1), tf_check_alpha(c, 0.01));
    TOLD("alpha 1", tf_check_alpha(c, 1), tf_check_alpha(c, 0.01));
    TOLD("draws", tf_check_draws(c, 0), tf_check_draws(c, 100));
    TOLD("batch", tf_check_batch(c, 0), tf_check_batch(c, 1));
    TOLD("tolerance", tf_check_tolerance(c, 0), tf_check_tolerance(c, 0.01));
    TOLD("its own", tf_check_variance_tolerance(c, INFINITY), tf_check_variance_tolerance(c, 0.1));
    TOLD("truth", tf_check_truth(c, NAN), tf_check_truth(c, 0.5));
    TOLD("truths", tf_check_truths(c, list, 2), tf_check_truths(c, fine, 2));
    TOLD("no truths", tf_check_truths(c, list, 0), tf_check_truths(c, fine, 2));
    TOLD("variance", tf_check_variance(c, -1), tf_check_variance(c, 1));
    TOLD("variances", tf_check_variances(c, list, 2), tf_check_variances(c, fine, 2));
    TOLD("kurtosis", tf_check_kurtosis(c, 0.5), tf_check_kurtosis(c, 3));
    TOLD("kurtoses", tf_check_kurtoses(c, list, 2), tf_check_kurtosis(c, 3));
    TOLD("range", tf_check_range(c, 1, 0), tf_check_range(c, 0, 1));
    TOLD("range nan", tf_check_range(c, 0, NAN), tf_check_range(c, 0, 1));
    TOLD("lookups", tf_check_lookups(c, 0, 1), tf_check_lookups(c, 1, 1));
    TOLD("rounding", tf_check_rounding(c, -1), tf_check_rounding(c, 0));
    TOLD("case", tf_check_of(c, "nope", "x", NAN), tf_check_truth(c, 0.5));

    /* What only goes wrong together is told when it is used, and not by asking whether draws are wanted. */
    tf_check *check = tf_check_new("together");
    if (tf_check_truth(check, 2) || tf_check_range(check, 0, 1)) ++wrong;
    printf("asked: %d\n", tf_check_is_open(check));
    tf_verdict verdict;
    const tf_status status = tf_check_verdict(check, &verdict);
    printf("together: %d %s\n", (int)status, tf_last_error());
    tf_check_free(check);
    return wrong;
}
