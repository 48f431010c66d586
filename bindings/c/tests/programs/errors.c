/* Bad input: each line is the code and the message of one mistake. */
#include <stdio.h>

#include "trueflight.h"

static double none(tf_rng *rng, void *user)
{
    (void)rng, (void)user;
    return NAN;
}

static size_t too_many(double *out, size_t draws, tf_rng *rng, void *user)
{
    (void)out, (void)rng, (void)user;
    return draws + 1;
}

static void told(const char *what, tf_status status)
{
    printf("%s: %d %s\n", what, (int)status, tf_last_error());
}

static tf_check *half(void)
{
    tf_check *check = tf_check_new("half");
    TF_SET(check, TF_TRUTH, 0.5);
    return check;
}

int main(void)
{
    const double draws[3] = {0.5, 0.25, 0.75};
    const double truths[2] = {0.5, 0.5};
    tf_verdict verdict;
    tf_numbers numbers;
    tf_check *check;

    check = tf_check_new(NULL);
    printf("no name: %d %s\n", check == NULL, tf_last_error());
    check = tf_check_new("\xff");
    printf("bad name: %d %s\n", check == NULL, tf_last_error());
    told("no check", TF_SET(NULL, TF_TRUTH, 0.5));
    printf("text of no check: %s\n", tf_check_text(NULL));
    printf("no check passes: %d\n", tf_check_passed(NULL));
    tf_check_free(NULL);

    check = half();
    told("no draws pointer", tf_check_absorb(check, NULL, 3));
    told("it stays", tf_check_verdict(check, &verdict));
    printf("and is the text: %s\n", tf_check_text(check));
    printf("passed: %d, open: %d\n", tf_check_passed(check), tf_check_is_open(check));
    tf_check_free(check);

    check = half();
    told("no callback", tf_check_run(check, NULL, NULL));
    tf_check_free(check);

    check = half();
    told("too many", tf_check_run_batches(check, 1, too_many, NULL));
    tf_check_free(check);

    check = half();
    told("no draws", tf_check_verdict(check, &verdict));
    tf_check_free(check);

    check = tf_check_new("nothing said");
    told("no truth", tf_check_absorb(check, draws, 3));
    tf_check_free(check);

    check = half();
    TF_SET(check, TF_RANGE, 0.6, 1.0);
    told("range", tf_check_absorb(check, draws, 3));
    tf_check_free(check);

    check = half();
    tf_check_of(check, "no/such-case", "ratio", 1.0);
    told("no such case", tf_check_absorb(check, draws, 3));
    tf_check_free(check);

    check = tf_check_new("pairs");
    tf_check_set(check, TF_TRUTH, truths, 2);
    told("ragged", tf_check_absorb(check, draws, 3));
    tf_check_free(check);

    check = tf_check_new("pairs");
    tf_check_set(check, TF_TRUTH, truths, 2);
    told("one of two", tf_check_run(check, none, NULL));
    tf_check_free(check);

    check = half();
    TF_SET(check, TF_LOOKUPS, 3, 3);
    told("lookups", tf_check_absorb(check, draws, 3));
    tf_check_free(check);

    check = half();
    tf_check_absorb(check, draws, 3);
    told("too late", TF_SET(check, TF_VARIANCE, 1.0));
    tf_check_free(check);

    check = half();
    tf_check_absorb(check, draws, 3);
    told("no place", tf_check_verdict(check, NULL));
    told("no harm", tf_check_verdict(check, &verdict));
    told("no such value", tf_check_numbers(check, 1, &numbers));
    told("after the verdict", tf_check_absorb(check, draws, 3));
    tf_check_free(check);

    check = half();
    tf_check_run(check, none, NULL);
    tf_check_verdict(check, &verdict);
    printf("nan: %d %s\n", verdict == TF_VERDICT_FAIL, tf_check_reason(check));
    tf_check_free(check);
    return 0;
}
