/* Trueflight in C++17: is my Monte Carlo estimator unbiased?
 *
 *     trueflight::check("analogue", [](auto& rng) { return -std::log(rng.positive_uniform()) > 1 ? 1.0 : 0.0; })
 *         .truth(std::exp(-1.0)).range(0, 1).assert_pass();
 *
 * A wrapper of trueflight.h: what a setter means stands there, under the same name. A draw is a number, or a std::array
 * of them; its type says how many values it has. What makes no sense throws `error`, a verdict other than pass
 * `not_passed`; an exception of the estimator's comes through as it is. A check is used by one thread at a time, and not
 * by its own estimator; different checks are independent.
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

/** A check has no verdict. */
class error : public std::runtime_error {
  public:
    explicit error(tf_status status) : std::runtime_error(tf_last_error()), status_(status) {}
    tf_status status() const noexcept { return status_; }

  private:
    tf_status status_;
};

/** A verdict is fail or inconclusive; the text is that of the verdict. */
class not_passed : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

/** The random stream of an estimator; also a generator for the distributions of <random>. */
class rng {
  public:
    using result_type = std::uint64_t;
    explicit rng(tf_rng *stream) : stream_(stream) {}

    /** In [0, 1). */
    double uniform() { return tf_rng_uniform(stream_); }
    /** In (0, 1]: its logarithm is finite. */
    double positive_uniform() { return tf_rng_positive_uniform(stream_); }

    result_type operator()() { return tf_rng_word(stream_); }
    static constexpr result_type min() { return 0; }
    static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  private:
    tf_rng *stream_;
};

/** What was found. */
struct outcome {
    tf_verdict verdict;
    /** Of each value of a draw. */
    std::vector<tf_numbers> values;
    /** Why it is no pass; empty for a plain pass. */
    std::string reason;
    /** All of it in a few lines. */
    std::string text;

    bool passed() const noexcept { return verdict == TF_VERDICT_PASS; }
};

inline std::ostream &operator<<(std::ostream &out, const outcome &found) { return out << found.text; }

namespace detail {

inline void need(tf_status status)
{
    if (status != TF_STATUS_OK) throw error(status);
}

/** How a draw is written: a number, or several. */
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

/** An estimator, and what it threw: no exception may go through C. */
template <class F> struct trampoline {
    using one = draw<std::decay_t<decltype(std::declval<F &>()(std::declval<rng &>()))>>;
    F &estimator;
    std::exception_ptr thrown;

    static std::size_t fill(double *out, std::size_t draws, tf_rng *stream, void *user)
    {
        auto *self = static_cast<trampoline *>(user);
        try {
            // In registers while draws are made.
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

/** What is known of a draw; `Self` is the check, so that calls can be chained. */
template <class Self> class setup {
  public:
    /** One truth serves all values of a draw; a list has one for each. */
    Self &truth(double value) { return said(tf_check_truth(get(), value)); }
    Self &truth(const std::vector<double> &list) { return said(tf_check_truths(get(), list.data(), list.size())); }
    Self &variance(double value) { return said(tf_check_variance(get(), value)); }
    Self &variance(const std::vector<double> &list) { return said(tf_check_variances(get(), list.data(), list.size())); }
    Self &kurtosis(double value) { return said(tf_check_kurtosis(get(), value)); }
    Self &kurtosis(const std::vector<double> &list) { return said(tf_check_kurtoses(get(), list.data(), list.size())); }
    Self &range(double low, double high) { return said(tf_check_range(get(), low, high)); }
    Self &lookups(double mean, double variance) { return said(tf_check_lookups(get(), mean, variance)); }
    Self &rounding(double value) { return said(tf_check_rounding(get(), value)); }
    Self &tolerance(double value) { return said(tf_check_tolerance(get(), value)); }
    Self &variance_tolerance(double value) { return said(tf_check_variance_tolerance(get(), value)); }
    Self &alpha(double value) { return said(tf_check_alpha(get(), value)); }
    Self &draws(std::uint64_t count) { return said(tf_check_draws(get(), count)); }
    Self &seed(std::uint64_t value) { return said(tf_check_seed(get(), value)); }
    Self &batch(std::uint64_t count) { return said(tf_check_batch(get(), count)); }
    Self &values(std::size_t count) { return said(tf_check_set_values(get(), count)); }
    Self &mean_only() { return said(tf_check_mean_only(get())); }
    /** Without a value of what the case sweeps, the case's own. */
    Self &of(const std::string &name, const std::string &estimator,
             double swept = std::numeric_limits<double>::quiet_NaN())
    {
        return said(tf_check_of(get(), name.c_str(), estimator.c_str(), swept));
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
    Self &said(tf_status status)
    {
        detail::need(status);
        return static_cast<Self &>(*this);
    }

    std::unique_ptr<tf_check, decltype(&tf_check_free)> handle_;
};

/** A check of draws that are pushed. */
class pushed : public setup<pushed> {
  public:
    explicit pushed(const std::string &name) : setup(name) {}

    /** Draws of several values lie one draw after the other; `count` is the number of numbers. */
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

    /** Whether more draws may change what is said. */
    bool is_open() const noexcept { return tf_check_is_open(get()) != 0; }
    /** Judges; no draw can follow. */
    outcome verdict() const { return judged(); }
    void assert_pass() const
    {
        const outcome found = judged();
        if (!found.passed()) throw not_passed(found.text);
    }
};

/** A check of draws that an estimator makes. */
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

/** A check of an estimator: a callable that takes an `rng &` and returns a draw. */
template <class F> drawn<std::decay_t<F>> check(const std::string &name, F &&estimator)
{
    return drawn<std::decay_t<F>>(name, std::forward<F>(estimator));
}

/** A check of draws that come later. */
inline pushed claim(const std::string &name) { return pushed(name); }

} // namespace trueflight

#endif /* TRUEFLIGHT_HPP */
