/* Properties of a claim: the setter records, the first draws return the error, and the last value counts. */
#include <stdio.h>
#include <string.h>

#include "trueflight.h"

static int wrong = 0;

static tf_check *begin(const char *what)
{
    tf_check *check = tf_check_new(what);
    TF_SET(check, TF_TRUTH, 0.5);
    TF_SET(check, TF_VARIANCE, 1);
    return check;
}

/* Prints the error of the first draws, which all later calls return. */
static void told(const char *what, tf_check *check)
{
    const double draw = 0.5;
    tf_verdict verdict;
    const tf_status first = tf_check_absorb(check, &draw, 1);
    printf("%s: %d %s\n", what, (int)first, tf_last_error());
    if (first == TF_STATUS_OK || tf_check_verdict(check, &verdict) != first) ++wrong;
    if (TF_SET(check, TF_ALPHA, 0.01) != first || strcmp(tf_check_text(check), tf_last_error()) != 0) ++wrong;
    tf_check_free(check);
}

/* A value out of its range: the setter records it. */
#define INVALID(WHAT, KEY, ...)                   \
    do {                                          \
        tf_check *c = begin(WHAT);                \
        if (TF_SET(c, KEY, __VA_ARGS__)) ++wrong; \
        told(WHAT, c);                            \
    } while (0)

/* Numbers that a key does not take: an error of the setter. */
#define UNFIT(WHAT, KEY, ...)                                      \
    do {                                                           \
        tf_check *c = begin(WHAT);                                 \
        if (TF_SET(c, KEY, __VA_ARGS__) != TF_STATUS_CLAIM) ++wrong; \
        told(WHAT, c);                                             \
    } while (0)

int main(void)
{
    const double draw = 0.5;
    INVALID("alpha", TF_ALPHA, -1);
    INVALID("alpha 1", TF_ALPHA, 1);
    INVALID("tolerance", TF_TOLERANCE, 0);
    INVALID("its own", TF_VARIANCE_TOLERANCE, INFINITY);
    INVALID("truth", TF_TRUTH, NAN);
    INVALID("truths", TF_TRUTH, 0.5, NAN);
    INVALID("variance", TF_VARIANCE, -1);
    INVALID("variances", TF_VARIANCE, 1, 1);
    INVALID("kurtosis", TF_KURTOSIS, 0.5);
    INVALID("range", TF_RANGE, 1, 0);
    INVALID("range nan", TF_RANGE, 0, NAN);
    INVALID("range of others", TF_RANGE, 0.6, 1);
    INVALID("lookups", TF_LOOKUPS, 0, 1);
    INVALID("rounding", TF_ROUNDING, -1);
    UNFIT("no draws", TF_DRAWS, 0);
    UNFIT("half a draw", TF_DRAWS, 0.5);
    UNFIT("negative draws", TF_DRAWS, -1);
    UNFIT("more draws", TF_DRAWS, 1e19);
    UNFIT("no batch", TF_BATCH, 0);
    UNFIT("two batches", TF_BATCH, 1, 2);
    UNFIT("no values", TF_VALUES, 0);
    UNFIT("more values", TF_VALUES, 65537);
    UNFIT("one end", TF_RANGE, 1);
    UNFIT("three lookups", TF_LOOKUPS, 1, 2, 3);
    UNFIT("more than the mean", TF_MEAN_ONLY, 2);

    tf_check *check = begin("no truths");
    if (tf_check_set(check, TF_TRUTH, NULL, 0)) ++wrong;
    told("no truths", check);
    check = begin("no array");
    if (tf_check_set(check, TF_TRUTH, NULL, 1) != TF_STATUS_NULL_POINTER) ++wrong;
    told("no array", check);
    check = begin("no key");
    if (tf_check_set(check, (tf_key)99, &draw, 1) != TF_STATUS_KEY) ++wrong;
    told("no key", check);
    check = begin("case");
    tf_check_of(check, "nope", "x", NAN);
    told("case", check);

    check = begin("last");
    TF_SET(check, TF_ALPHA, -1), TF_SET(check, TF_ALPHA, 0.01);
    printf("last: %d, %d\n", tf_check_is_open(check), (int)tf_check_absorb(check, &draw, 1));
    tf_check_free(check);
    return wrong;
}
