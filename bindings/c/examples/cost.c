/* What a callback costs a draw, and what the gate does, in nanoseconds of processor time: the median of what short runs took
 * in turn, and of what two of them differ by. Whatever else a machine does slows down both, and never one alone for long.
 *
 * The same estimator in a loop that only sums up, by a callback a draw, and by a callback a batch. The gate's cost would
 * hide that of the callback, so the callback's is measured on averages of 4096 draws, which the gate has little work
 * with; the gate's on draws that are there, judged one by one, by their range or by their variance. */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "trueflight.h"

static double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return 1e9 * (double)time.tv_sec + (double)time.tv_nsec;
}

/* Cheap: uniform. */
static inline double uniform(tf_rng *rng) { return tf_rng_uniform(rng); }

/* Usual: ratio tracking in σ_t = exp(−t) on [0, 3], three lookups a draw. */
static inline double ratio(tf_rng *rng)
{
    double weight = 1;
    for (double t = -log(tf_rng_positive_uniform(rng)); t < 3; t -= log(tf_rng_positive_uniform(rng)))
        weight *= 1 - exp(-t);
    return weight;
}

/* The same as a callback a draw, as a callback a batch, and as a loop. */
#define ESTIMATOR(NAME)                                                            \
    static double NAME##_draw(tf_rng *rng, void *user)                             \
    {                                                                              \
        (void)user;                                                                \
        return NAME(rng);                                                          \
    }                                                                              \
    static size_t NAME##_batch(double *out, size_t n, tf_rng *rng, void *user)     \
    {                                                                              \
        (void)user;                                                                \
        tf_rng own = *rng; /* in registers */                                      \
        for (size_t i = 0; i < n; ++i) out[i] = NAME(&own);                        \
        return n;                                                                  \
    }                                                                              \
    static double NAME##_loop(size_t n)                                            \
    {                                                                              \
        tf_rng rng = {{1, 2, 3, 4}};                                               \
        double sum = 0;                                                            \
        for (size_t i = 0; i < n; ++i) sum += NAME(&rng);                          \
        return sum;                                                                \
    }
ESTIMATOR(uniform)
ESTIMATOR(ratio)

/* What is known of the draws. */
struct problem {
    const char *name;
    double truth, variance;
    double (*loop)(size_t);
    tf_draw_function draw;
    tf_batch_function batch;
};

/* The first way is not counted: it takes the memory from the system that the last one gave back. */
enum way { WARM, LOOP, DRAW, BATCH, AVERAGES, BY_RANGE, BY_VARIANCE, WAYS };
enum { RUNS = 101 };

/* Runs one way; the time that it takes. */
static double timed(const struct problem *problem, enum way way, const double *draws, size_t count)
{
    static volatile double sink;
    tf_check *check = tf_check_new(problem->name);
    TF_SET(check, TF_TRUTH, problem->truth);
    TF_SET(check, TF_DRAWS, count);
    if (way == BY_VARIANCE) TF_SET(check, TF_VARIANCE, problem->variance);
    else TF_SET(check, TF_RANGE, 0, 1);
    if (way == WARM || way == DRAW || way == BATCH || way == AVERAGES) TF_SET(check, TF_BATCH, 4096);

    const double start = now();
    switch (way) {
    case LOOP: sink = problem->loop(count); break;
    case WARM:
    case DRAW: tf_check_run(check, problem->draw, NULL); break;
    case BATCH: tf_check_run_batches(check, 1, problem->batch, NULL); break;
    default: tf_check_absorb(check, draws, count); break;
    }
    const double took = now() - start;
    (void)sink;

    tf_verdict verdict;
    if (way != LOOP && tf_check_verdict(check, &verdict) != TF_STATUS_OK) {
        fprintf(stderr, "%s\n", tf_last_error());
        exit(2);
    }
    tf_check_free(check);
    return took / (double)count;
}

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values)
{
    qsort(values, RUNS, sizeof *values, compare);
    return values[RUNS / 2];
}

static void measure(const struct problem *problem, double *draws, size_t count)
{
    static double took[WAYS][RUNS];
    tf_rng rng = {{5, 6, 7, 8}};
    problem->batch(draws, count, &rng, NULL);
    for (int run = 0; run < RUNS; ++run) {
        for (int way = 0; way < WAYS; ++way) took[way][run] = timed(problem, (enum way)way, draws, count);
        const double common = took[LOOP][run] + took[AVERAGES][run];
        took[DRAW][run] -= common;
        took[BATCH][run] -= common;
    }
    printf("%-8s %8.2f %12.2f %12.2f %14.2f %14.2f\n", problem->name, median(took[LOOP]), median(took[DRAW]),
           median(took[BATCH]), median(took[BY_RANGE]), median(took[BY_VARIANCE]));
}

int main(int argc, char **argv)
{
    const size_t count = argc > 1 ? strtoul(argv[1], NULL, 10) : (size_t)1 << 18;
    const double tau = 1 - exp(-3.0), over = (1 - exp(-6.0)) / 2;
    const struct problem problems[] = {
        {"uniform", 0.5, 1.0 / 12, uniform_loop, uniform_draw, uniform_batch},
        {"ratio", exp(-tau), exp(-2 * tau) * (exp(over) - 1), ratio_loop, ratio_draw, ratio_batch},
    };
    double *draws = malloc(count * sizeof *draws);
    if (!draws || count == 0) return 2;
    printf("ns a draw, %d runs of %zu draws\n", RUNS, count);
    puts("         the draw  + callback  + its batch  gate by range  gate by variance");
    for (int i = 0; i < 2; ++i) measure(&problems[i], draws, count);
    free(draws);
    return 0;
}
