// SPDX-License-Identifier: Apache-2.0
// Tests of means, with stated rates of false alarm: Student's t, Welch's test of two means, Holm's correction for many tests at once.
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace sunstone::test {

// I_x(a, b), regularised, by its continued fraction. a, b > 0, x in [0, 1].
double incomplete_beta(double a, double b, double x);

// Chance that |T| >= |t| for Student's t with `freedom` degrees of freedom.
double student_two_sided(double t, double freedom);
// The t with student_two_sided(t) == p.
double student_quantile(double p, double freedom);

struct Moments {
  std::size_t count = 0;
  double mean = 0, variance = 0;  // of one value, by n - 1
};
Moments moments(std::span<const double> values);

// Welch's test: the chance that two means of one and the same expectation lie this far apart. 1 where both are equal constants, 0 where they are constants
// that differ by more than rounding.
double welch(std::span<const double> a, std::span<const double> b);

// Holm's step-down: which hypotheses are rejected if the chance of any false rejection is to be at most `alpha`.
std::vector<std::size_t> holm_rejected(std::span<const double> p, double alpha);

// Half the width of the interval about the mean that misses the expectation with chance `alpha`.
double interval(const Moments &m, double alpha);

}  // namespace sunstone::test
