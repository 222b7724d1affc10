// SPDX-License-Identifier: Apache-2.0
#include "core/predicates/expansion.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/quad.hpp"

namespace tinsmith {
namespace {

using namespace core;
using test::Quad;

/// Doubles of all signs and of magnitudes from 2^-24 to 2^24, so that 113 bits hold their sums.
double random_double(std::mt19937_64& random) {
    const double mantissa = std::uniform_real_distribution<double>(1.0, 2.0)(random);
    const int exponent = static_cast<int>(random() % 49) - 24;
    return std::ldexp(random() % 2 == 0 ? mantissa : -mantissa, exponent);
}

Quad whole(const Exact& e) {
    return Quad(e.value) + Quad(e.rest);
}

// Out of line and by reference, so that the compiler sees neither the values nor a reason to keep
// the product apart from the sum.
[[gnu::noinline]] double product_and_sum(const double& a, const double& b, const double& c) {
    return a * b + c;
}

TEST(Expansion, SumsDifferencesAndProductsLoseNothing) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 200'000; ++i) {
        const double a = random_double(random), b = random_double(random);
        const Exact sum = exact_sum(a, b);
        const Exact difference = exact_difference(a, b);
        const Exact product = exact_product(a, b);
        ASSERT_EQ(sum.value, a + b);
        ASSERT_EQ(product.value, a * b);
        ASSERT_TRUE(whole(sum) == Quad(a) + Quad(b)) << a << " + " << b;
        ASSERT_TRUE(whole(difference) == Quad(a) - Quad(b)) << a << " - " << b;
        ASSERT_TRUE(whole(product) == Quad(a) * Quad(b)) << a << " * " << b;
    }
}

TEST(Expansion, ProductsLoseNothingAtTheEndsOfTheCoordinateRange) {
    for (const double a : {1e15, -1e15 / 3.0, 1e-60, 1e-60 / 3.0, 2e15})
        for (const double b : {1e15, 2e15 / 7.0, 1e-60, -1e-60 / 7.0})
            EXPECT_TRUE(whole(exact_product(a, b)) == Quad(a) * Quad(b)) << a << " * " << b;
}

TEST(Expansion, AProductAndASumAreRoundedOneByOne) {
    std::mt19937_64 random(2);
    int fused_differs = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double a = random_double(random), b = random_double(random);
        const double c = -exact_product(a, b).value;
        // Rounded one by one, the product cancels to zero; fused, what rounding left out remains.
        ASSERT_EQ(product_and_sum(a, b, c), 0.0) << "-ffp-contract=off is not in force";
        if (std::fma(a, b, c) != 0.0) ++fused_differs;
    }
    EXPECT_GT(fused_differs, 90'000) << "the case does not tell fused from unfused";
}

TEST(Expansion, ASumHasTheSignOfTheWhole) {
    std::mt19937_64 random(3);
    for (int i = 0; i < 20'000; ++i) {
        Expansion<16> sum;
        Quad expected = 0;
        for (int k = 0; k < 15; ++k) {
            const double x = random_double(random);
            sum.add(x);
            expected += Quad(x);
        }
        const double last = static_cast<double>(-expected);  // leaves a rest of rounding at most
        sum.add(last);
        expected += Quad(last);
        ASSERT_EQ(sum.sign(), test::sign(expected));
        const double size = std::fabs(static_cast<double>(expected));
        ASSERT_LE(std::fabs(sum.estimate() - static_cast<double>(expected)), 1e-15 * size);
    }
}

TEST(Expansion, ASumOfOppositesIsZeroInWhateverOrder) {
    std::mt19937_64 random(4);
    for (int i = 0; i < 20'000; ++i) {
        std::vector<double> terms;
        for (int k = 0; k < 8; ++k) {
            terms.push_back(random_double(random) * std::ldexp(1.0, 20 * k));
            terms.push_back(-terms.back());
        }
        std::shuffle(terms.begin(), terms.end(), random);
        Expansion<16> sum;
        for (const double x : terms)
            sum.add(x);
        ASSERT_EQ(sum.sign(), 0);
        ASSERT_EQ(sum.estimate(), 0.0);
    }
}

TEST(Expansion, AnEmptySumIsZero) {
    Expansion<4> sum;
    EXPECT_EQ(sum.sign(), 0);
    EXPECT_EQ(sum.estimate(), 0.0);
}

TEST(Expansion, ASumSeesASmallTermBesideLargeOnes) {
    Expansion<4> sum;
    sum.add(1e15);
    sum.add(-1e-60);
    sum.add(-1e15);
    EXPECT_EQ(sum.sign(), -1);
    EXPECT_EQ(sum.estimate(), -1e-60);
}

}  // namespace
}  // namespace tinsmith
