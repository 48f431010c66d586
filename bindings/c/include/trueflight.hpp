/* Trueflight in C++17: is my Monte Carlo estimator unbiased?
 *
 *     trueflight::check("analogue", [](auto& rng) { return -std::log(rng.positive_uniform()) > 1 ? 1.0 : 0.0; })
 *         .truth(std::exp(-1.0)).range(0, 1).assert_pass();
 *
 * A wrapper of trueflight.h, which documents each property: `.truth(x)` sets TF_TRUTH. A draw is a number, or a std::array
 * of them; its type says how many values it has. Setters record, and the first draws or the verdict validate: an invalid
 * claim throws `error`, a verdict other than pass `not_passed`; an exception of the estimator's comes through as it is.
 * One thread at a time uses a check, and its own estimator must not. Different checks are independent.
 */
#ifndef TRUEFLIGHT_HPP
#define TRUEFLIGHT_HPP

#include <array>
#include <exception>
#include <limits>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "trueflight.h"

namespace trueflight {

/** Error of a check, which has no verdict. */
class error : public std::runtime_error {
  public:
    explicit error(tf_status status) : std::runtime_error(tf_last_error()), status_(status) {}
    tf_status status() const noexcept { return status_; }

  private:
    tf_status status_;
};

/** Verdict of fail or inconclusive; the message is the text of the verdict. */
class not_passed : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/** Random stream of an estimator; also a generator for the distributions of <random>. */
class rng {
  public:
    using result_type = std::uint64_t;
    explicit rng(tf_rng *stream) : stream_(stream) {}

    /** Returns a uniform number in [0, 1). */
    double uniform() { return tf_rng_uniform(stream_); }
    /** Returns a uniform number in (0, 1]. Its logarithm is finite. */
    double positive_uniform() { return tf_rng_positive_uniform(stream_); }

    result_type operator()() { return tf_rng_word(stream_); }
    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  private:
    tf_rng *stream_;
};

/** Verdict with its measurements. */
struct outcome {
    tf_verdict verdict;
    /** Measurements of each value of a draw. */
    std::vector<tf_numbers> values;
    /** Reason of a verdict other than pass; empty for a plain pass. */
    std::string reason;
    /** Verdict in a few lines, as `trueflight judge` prints it. */
    std::string text;

    bool passed() const noexcept { return verdict == TF_VERDICT_PASS; }
};

inline std::ostream &operator<<(std::ostream &out, const outcome &found) { return out << found.text; }

namespace detail {

inline void need(tf_status status)
{
    if (status != TF_STATUS_OK) throw error(status);
}

/** Conversion of a draw to one or several numbers. */
template <class T> struct draw {
    static_assert(std::is_arithmetic<T>::value, "a draw is a number or a std::array of numbers");
    static constexpr std::size_t values = 1;
    static void write(double *out, const T &x) { *out = static_cast<double>(x); }
};

template <class T, std::size_t K> struct draw<std::array<T, K>> {
    static_assert(std::is_arithmetic<T>::value, "a draw is a number or a std::array of numbers");
    static_assert(K > 0, "a draw has one value at least");
    static constexpr std::size_t values = K;
    static void write(double *out, const std::array<T, K> &xs)
    {
        for (std::size_t i = 0; i < K; ++i) out[i] = static_cast<double>(xs[i]);
    }
};

/** Estimator with the exception that it threw: none may pass through C. */
template <class F> struct trampoline {
    using one = draw<std::decay_t<decltype(std::declval<F &>()(std::declval<rng &>()))>>;
    F &estimator;
    std::exception_ptr thrown;

    static std::size_t fill(double *out, std::size_t draws, tf_rng *stream, void *user)
    {
        auto *self = static_cast<trampoline *>(user);
        try {
            // A local copy stays in registers.
            tf_rng local = *stream;
            rng random(&local);
            for (std::size_t i = 0; i < draws; ++i, out += one::values) {
                one::write(out, self->estimator(random));
            }
            return draws;
        } catch (...) {
            self->thrown = std::current_exception();
            return 0;
        }
    }
};

} // namespace detail

/** Setters of a claim; `Self` is the check, so that calls can be chained. */
template <class Self> class setup {
  public:
    /** One number serves all values of a draw; a list has one for each. */
    Self &truth(double value) { return set(TF_TRUTH, {value}); }
    Self &truth(const std::vector<double> &list) { return set(TF_TRUTH, list); }
    Self &variance(double value) { return set(TF_VARIANCE, {value}); }
    Self &variance(const std::vector<double> &list) { return set(TF_VARIANCE, list); }
    Self &kurtosis(double value) { return set(TF_KURTOSIS, {value}); }
    Self &kurtosis(const std::vector<double> &list) { return set(TF_KURTOSIS, list); }
    Self &range(double low, double high) { return set(TF_RANGE, {low, high}); }
    Self &lookups(double mean, double variance) { return set(TF_LOOKUPS, {mean, variance}); }
    Self &rounding(double value) { return set(TF_ROUNDING, {value}); }
    Self &tolerance(double value) { return set(TF_TOLERANCE, {value}); }
    Self &variance_tolerance(double value) { return set(TF_VARIANCE_TOLERANCE, {value}); }
    Self &alpha(double value) { return set(TF_ALPHA, {value}); }
    Self &draws(std::uint64_t count) { return set(TF_DRAWS, {static_cast<double>(count)}); }
    Self &batch(std::uint64_t count) { return set(TF_BATCH, {static_cast<double>(count)}); }
    Self &values(std::size_t count) { return set(TF_VALUES, {static_cast<double>(count)}); }
    Self &mean_only() { return set(TF_MEAN_ONLY, {1}); }
    Self &seed(std::uint64_t value) { return done(tf_check_seed(get(), value)); }
    /** Takes the case's own σ̂ unless `swept` says a value. */
    Self &of(const std::string &name, const std::string &estimator,
             double swept = std::numeric_limits<double>::quiet_NaN())
    {
        return done(tf_check_of(get(), name.c_str(), estimator.c_str(), swept));
    }

    tf_check *get() const noexcept { return handle_.get(); }

  protected:
    explicit setup(const std::string &name) : handle_(tf_check_new(name.c_str()), &tf_check_free)
    {
        if (!handle_) throw error(TF_STATUS_TEXT);
    }

    outcome judged() const
    {
        outcome found;
        detail::need(tf_check_verdict(get(), &found.verdict));
        found.values.resize(tf_check_values(get()));
        for (std::size_t i = 0; i < found.values.size(); ++i) detail::need(tf_check_numbers(get(), i, &found.values[i]));
        found.reason = tf_check_reason(get());
        found.text = tf_check_text(get());
        return found;
    }

  private:
    Self &set(tf_key key, const std::vector<double> &numbers)
    {
        return done(tf_check_set(get(), key, numbers.data(), numbers.size()));
    }

    Self &done(tf_status status)
    {
        detail::need(status);
        return static_cast<Self &>(*this);
    }

    std::unique_ptr<tf_check, decltype(&tf_check_free)> handle_;
};

/** Check of draws that are pushed. */
class pushed : public setup<pushed> {
  public:
    explicit pushed(const std::string &name) : setup(name) {}

    /** Adds draws. Those of several values are stored one draw after the other; `count` is the number of numbers. */
    pushed &absorb(const double *draws, std::size_t count)
    {
        detail::need(tf_check_absorb(get(), draws, count));
        return *this;
    }
    pushed &absorb(const std::vector<double> &draws) { return absorb(draws.data(), draws.size()); }
    pushed &absorb(const std::vector<double> &draws, const std::vector<double> &lookups)
    {
        detail::need(tf_check_absorb_with_lookups(get(), draws.data(), draws.size(), lookups.data(), lookups.size()));
        return *this;
    }

    /** Returns whether more draws may change the verdict. */
    bool is_open() const noexcept { return tf_check_is_open(get()) != 0; }
    /** Judges all draws; no draw can follow. */
    outcome verdict() const { return judged(); }
    void assert_pass() const
    {
        const outcome found = judged();
        if (!found.passed()) throw not_passed(found.text);
    }
};

/** Check of draws that an estimator makes. */
template <class F> class drawn : public setup<drawn<F>> {
  public:
    drawn(const std::string &name, F estimator) : setup<drawn<F>>(name), estimator_(std::move(estimator)) {}

    /** Draws and judges. */
    outcome verdict()
    {
        using trampoline = detail::trampoline<F>;
        trampoline made{estimator_, nullptr};
        const tf_status status = tf_check_run_batches(this->get(), trampoline::one::values, &trampoline::fill, &made);
        if (made.thrown) std::rethrow_exception(made.thrown);
        detail::need(status);
        return this->judged();
    }
    void assert_pass()
    {
        const outcome found = verdict();
        if (!found.passed()) throw not_passed(found.text);
    }

  private:
    F estimator_;
};

/** Makes a check of an estimator: a callable that takes an `rng &` and returns a draw. */
template <class F> drawn<std::decay_t<F>> check(const std::string &name, F &&estimator)
{
    return drawn<std::decay_t<F>>(name, std::forward<F>(estimator));
}

/** Makes a check of draws that come later. */
inline pushed claim(const std::string &name) { return pushed(name); }

} // namespace trueflight

#endif /* TRUEFLIGHT_HPP */
