// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>

#include "core/edit/neumaier_sum.hpp"

namespace tinsmith::core {

/// Sums what linear differences over triangles enclose with zero: above it, which is cut, and
/// below, which is fill. In closed form, cut at the zero line; sums are compensated.
class CutAndFill {
  public:
    /// Over a triangle of that area, with the differences at its corners.
    void add(double area, std::array<double, 3> d) {
        area_.add(area);
        const auto [least, most] = std::minmax({d[0], d[1], d[2]});
        if (least >= 0.0) {
            if (most > 0.0) above(area, d[0], d[1], d[2]);
        } else if (most <= 0.0) {
            below(area, d[0], d[1], d[2]);
        } else {
            add_bent(area, d);
        }
    }

    // None is ever negative.
    double cut() const { return of(cut_); }
    double fill() const { return of(fill_); }
    double area() const { return of(area_); }
    double cut_area() const { return of(cut_area_); }
    double fill_area() const { return of(fill_area_); }

  private:
    static double of(const NeumaierSum& sum) { return std::max(sum.value(), 0.0); }

    void above(double area, double a, double b, double c) {
        cut_.add(area * ((a + b + c) / 3.0));
        cut_area_.add(area);
    }
    void below(double area, double a, double b, double c) {
        fill_.add(-area * ((a + b + c) / 3.0));
        fill_area_.add(area);
    }

    /// Both signs: the corner a has a sign of its own, or b is zero.
    ///
    ///          a
    ///         / \         the zero line goes from s, on a-b, to t, on a-c;
    ///     s _/___\_ t     a-s-t has a's sign, s-b-c and s-c-t the other
    ///      b ----- c
    void add_bent(double area, std::array<double, 3> d) {
        // Turned until a alone has its sign: of three signs, two of which differ, one does.
        while (!(d[0] > 0.0 && d[1] <= 0.0 && d[2] <= 0.0) &&
               !(d[0] < 0.0 && d[1] >= 0.0 && d[2] >= 0.0))
            std::rotate(d.begin(), d.begin() + 1, d.end());
        const double a = d[0], b = d[1], c = d[2];
        const double to_s = a / (a - b), from_s = b / (b - a);
        const double to_t = a / (a - c), from_t = c / (c - a);
        const auto tip = [&](double part) {
            return a > 0.0 ? above(part, a, 0.0, 0.0) : below(part, a, 0.0, 0.0);
        };
        const auto rest = [&](double part, double e, double f) {
            if (part <= 0.0) return;
            return a > 0.0 ? below(part, 0.0, e, f) : above(part, 0.0, e, f);
        };
        tip(area * to_s * to_t);
        rest(area * from_s, b, c);
        rest(area * to_s * from_t, c, 0.0);
    }

    NeumaierSum cut_, fill_, area_, cut_area_, fill_area_;
};

}  // namespace tinsmith::core
