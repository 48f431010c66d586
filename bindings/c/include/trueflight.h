/* Trueflight: is my Monte Carlo estimator unbiased?
 *
 * Made by cbindgen from bindings/c/src. A check is used by one thread at a time; different checks are independent.
 * Texts are UTF-8. An error ends a check: all later calls answer the first one, so that it is enough to look at the
 * last. A number that makes no sense by itself is an error of the setter that is given it; what does not go together, as
 * a truth outside of the range, is one of the first draws. Callbacks return: they neither throw nor jump, and they leave
 * the check alone that they draw for.
 */

#ifndef TRUEFLIGHT_H
#define TRUEFLIGHT_H

#include <stddef.h>
#include <stdint.h>
#include <math.h>

// Whether a call did what it was asked for; `tf_last_error` says why not.
typedef enum {
  // It did.
  TF_STATUS_OK = 0,
  // A pointer is null.
  TF_STATUS_NULL_POINTER = 1,
  // A text is not UTF-8.
  TF_STATUS_TEXT = 2,
  // What was said of the draws makes no sense, does not go with their number of values, or is too little.
  TF_STATUS_CLAIM = 3,
  // A case or an estimator does not exist, or cannot be judged.
  TF_STATUS_CASE = 4,
  // Draws are missing, have no values or too many, are no whole number, or do not go with their lookups.
  TF_STATUS_DRAWS = 5,
  // A callback says that it made more draws than it was asked for.
  TF_STATUS_CALLBACK = 6,
  // Something was said of the draws after the first of them, draws came after the verdict, or a callback used the
  // check that it draws for.
  TF_STATUS_ORDER = 7,
  // A value that a draw does not have.
  TF_STATUS_INDEX = 8,
  // A defect of the library.
  TF_STATUS_INTERNAL = 9,
} tf_status;

// What is said of draws.
typedef enum {
  // They agree with what is claimed, and a difference of the size that matters would have been seen.
  TF_VERDICT_PASS = 0,
  // They differ by more than chance allows.
  TF_VERDICT_FAIL = 1,
  // The draws do not decide it.
  TF_VERDICT_INCONCLUSIVE = 2,
} tf_verdict;

// A check: a name, what is known of a draw, and the verdict on draws.
typedef struct tf_check tf_check;

// A random stream: xoshiro256+, the generator of the Rust library. Read it by `tf_rng_uniform` and the like.
typedef struct {
  // Where it stands; not all zero.
  uint64_t state[4];
} tf_rng;

// A callback that makes one draw with the help of a random stream; the pointer is the one that was given to
// `tf_check_run`. It must return: an exception that leaves it ends the process.
typedef double (*tf_draw_function)(tf_rng *rng, void *user);

// A callback that makes up to so many draws, one after the other, each with all its values, and answers how many it
// made: fewer if there are no more. There is room for as many numbers as draws times values.
typedef size_t (*tf_batch_function)(double *out, size_t draws, tf_rng *rng, void *user);

// What was found of one value of the draws; NAN is unknown.
typedef struct {
  // What is said of this value.
  tf_verdict verdict;
  // How many draws there were.
  uint64_t draws;
  // What the mean should be.
  double truth;
  // What it is.
  double mean;
  // The mean's standard error: from the variance claimed, else from that of the draws.
  double standard_error;
  // (mean − truth) in standard errors.
  double z;
  // The unbiased sample variance.
  double variance;
  // The sample variance, relative to the one claimed.
  double variance_ratio;
  // The sample kurtosis.
  double kurtosis;
} tf_numbers;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// What went wrong in the last call that did, on this thread; empty if none did. The text has the same place all the
// thread's life: another call that goes wrong writes over it. It is cut after 16383 bytes; `tf_check_text` has all.
const char *tf_last_error(void);

// The library's version, as in "0.1.0".
const char *tf_version(void);

// A check of that name, which says nothing of its draws yet; null if the name is null or not UTF-8. Free it by
// `tf_check_free`.
tf_check *tf_check_new(const char *name);

// The mean of a correct draw; of each of its values, if it has several.
tf_status tf_check_truth(tf_check *check, double truth);

// The same for draws of several values: one number for each value.
tf_status tf_check_truths(tf_check *check, const double *truths, size_t count);

// The variance of a correct draw; it is tested, too.
tf_status tf_check_variance(tf_check *check, double variance);

// The same, one number for each value.
tf_status tf_check_variances(tf_check *check, const double *variances, size_t count);

// The kurtosis of a correct draw, 3 for the normal law; without a variance an upper bound of it.
tf_status tf_check_kurtosis(tf_check *check, double kurtosis);

// The same, one number for each value.
tf_status tf_check_kurtoses(tf_check *check, const double *kurtoses, size_t count);

// Where correct draws lie; either end may be infinite. A draw outside fails.
tf_status tf_check_range(tf_check *check, double low, double high);

// Mean and variance of the number of lookups of a correct draw, which `tf_check_absorb_with_lookups` tells.
tf_status tf_check_lookups(tf_check *check,
                           double mean,
                           double variance);

// What rounding may add to a draw, relative to the truth; absolute for a truth of 0. Without it 3.6e-13; for draws in
// single precision some 1e-6. Call it before `tf_check_of`.
tf_status tf_check_rounding(tf_check *check,
                            double rounding);

// Number of values of a pushed draw, where it differs from the number of truths or of channels in the case: the luminance
// of a chromatic medium, which follows from the other channels, may be left out.
tf_status tf_check_set_values(tf_check *check,
                              size_t values);

// Of what theory says, only the mean: for an estimator of one's own that the case does not have.
tf_status tf_check_mean_only(tf_check *check);

// ε: the bias that a pass excludes, relative to the truth (absolute for a truth of 0). Without it 1 %, or with
// `tf_check_draws` what so many draws can see, at most 5 %.
tf_status tf_check_tolerance(tf_check *check,
                             double tolerance);

// The same for the variance, relative to it.
tf_status tf_check_variance_tolerance(tf_check *check, double tolerance);

// Judges averages of so many consecutive draws, which is for draws that depend on their neighbours; variance and
// kurtosis are then those of an average.
tf_status tf_check_batch(tf_check *check,
                         uint64_t batch);

// α: the chance that a correct estimator fails, 1e-3 without it. Of n checks together any fails with chance α at most
// if each has α/n.
tf_status tf_check_alpha(tf_check *check,
                         double alpha);

// So many draws, all of them, in place of as many as the decision takes (2^24 at most).
tf_status tf_check_draws(tf_check *check, uint64_t draws);

// Where the random streams of callbacks begin; 1 without it.
tf_status tf_check_seed(tf_check *check, uint64_t seed);

// Takes mean, variance, kurtosis, lookups and, where it is known, the whole distribution from theory: for an estimator of
// a case, by its name in tables or in the catalogue, at any value of what the case sweeps, or a constant σ̂ where it
// sweeps nothing; NAN takes the case's own. The case is a built-in one or a file. Every channel of the case is a value of
// the draw. A free flight that leaves the ray is its length, any larger number, INFINITY or −1.
tf_status tf_check_of(tf_check *check,
                      const char *case_,
                      const char *estimator,
                      double swept);

// Adds draws; those of several values lie one draw after the other, and `count` is the number of numbers. How many come
// in one call makes no difference.
tf_status tf_check_absorb(tf_check *check,
                          const double *draws,
                          size_t count);

// The same with the number of lookups of each draw: `lookup_count` of them.
tf_status tf_check_absorb_with_lookups(tf_check *check,
                                       const double *draws,
                                       size_t count,
                                       const double *lookups,
                                       size_t lookup_count);

// Whether more draws may change what is said: 1 or 0; 0 after an error, too.
int32_t tf_check_is_open(tf_check *check);

// Makes draws of one value by a callback until all is decided, or as many as `tf_check_draws` says. Each block of 2^14
// draws has a random stream of its own, which seed, name and block say. The callback must leave its check alone. Claims
// of several values are an error.
tf_status tf_check_run(tf_check *check,
                       tf_draw_function draw,
                       void *user);

// The same by a callback that makes many draws in one call, each of so many `values`: it may write that many numbers for
// each draw that it is asked for. One truth serves all values; a list of truths, or the channels of a case, must be as
// many. If it makes fewer draws than it is asked for, these are the last.
tf_status tf_check_run_batches(tf_check *check,
                               size_t values,
                               tf_batch_function fill,
                               void *user);

// The verdict on all values together: fail if any of them fails, pass if all pass.
tf_status tf_check_verdict(tf_check *check, tf_verdict *verdict);

// Whether the verdict is pass: 1 or 0; 0 after an error, too.
int32_t tf_check_passed(tf_check *check);

// How many values a draw has; 0 after an error.
size_t tf_check_values(tf_check *check);

// What was found of one value of the draws, counted from 0.
tf_status tf_check_numbers(tf_check *check, size_t value, tf_numbers *numbers);

// The verdict in a few lines, as `trueflight judge` writes it; after an error its message. Never null, and valid until
// the check is freed; of a check that is null, it is `tf_last_error`.
const char *tf_check_text(tf_check *check);

// Why the verdict is not pass, in words; empty for a plain pass, after an error its message. As long valid.
const char *tf_check_reason(tf_check *check);

// Frees a check; null is fine. A callback cannot free its own check, which is an error of the check.
void tf_check_free(tf_check *check);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* TRUEFLIGHT_H */

#ifndef TRUEFLIGHT_RNG_H
#define TRUEFLIGHT_RNG_H

// The next word of 64 bits; the lowest three are those of a linear generator.
static inline uint64_t tf_rng_word(tf_rng *rng)
{
    uint64_t *s = rng->state;
    const uint64_t word = s[0] + s[3], shifted = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= shifted;
    s[3] = (s[3] << 45) | (s[3] >> 19);
    return word;
}

// Uniform in [0, 1), all 53 bits: for decisions, uniform < p has probability p.
static inline double tf_rng_uniform(tf_rng *rng)
{
    return (double)(tf_rng_word(rng) >> 11) * (1.0 / 9007199254740992.0);
}

// Uniform in (0, 1]: its logarithm is finite.
static inline double tf_rng_positive_uniform(tf_rng *rng)
{
    return 1.0 - tf_rng_uniform(rng);
}

#endif /* TRUEFLIGHT_RNG_H */
