// SPDX-License-Identifier: Apache-2.0
#include "tests/support/point_clouds.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

namespace tinsmith::test {

namespace {

using Points = std::vector<core::Point3>;

/// Numbers from the engine's bits alone: the standard's distributions differ between libraries.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : random_(seed) {}
    double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
    double between(double low, double high) { return low + (high - low) * unit(); }
    std::uint64_t below(std::uint64_t count) { return random_() % count; }

  private:
    std::mt19937_64 random_;
};

/// Elevation by position, so that what is in one place twice has one elevation.
core::Point3 on_ground(double x, double y) {
    return {x, y, std::floor(x / 7.0) - std::floor(y / 3.0)};
}

std::size_t side_of(std::size_t size) {
    return std::max<std::size_t>(2, static_cast<std::size_t>(std::sqrt(double(size))));
}

/// A grid row by row; from and by what step.
Points grid(std::size_t size, double x, double y, double step) {
    Points points;
    const std::size_t side = side_of(size);
    for (std::size_t row = 0; row < side; ++row)
        for (std::size_t column = 0; column < side; ++column)
            points.push_back(on_ground(x + static_cast<double>(column) * step,
                                       y + static_cast<double>(row) * step));
    return points;
}

Points each(std::size_t size, std::uint64_t seed, core::Point3 (*point)(Dice&)) {
    Dice dice(seed);
    Points points(size);
    for (core::Point3& p : points)
        p = point(dice);
    return points;
}

double moved(double x, std::int64_t ulps) {
    for (; ulps > 0; --ulps)
        x = std::nextafter(x, HUGE_VAL);
    return x;
}

Points clustered(std::size_t size, std::uint64_t seed) {
    Dice dice(seed);
    Points points;
    while (points.size() < size) {
        const double x = dice.between(0, 1e5), y = dice.between(0, 1e5);
        const double reach = std::pow(10.0, dice.between(-6, 3));
        for (std::uint64_t i = dice.below(200) + 1; i > 0 && points.size() < size; --i)
            points.push_back(
                on_ground(x + dice.between(-reach, reach), y + dice.between(-reach, reach)));
    }
    return points;
}

Points nested(std::size_t size, std::uint64_t seed) {
    Dice dice(seed);
    Points points{on_ground(1, 1)};
    while (points.size() < size) {
        const double reach = std::pow(2.0, -dice.between(0, 140));
        points.push_back(on_ground(dice.unit() * reach, dice.unit() * reach));
    }
    return points;
}

std::vector<PointCloud> make_clouds() {
    const auto in_box = [](std::size_t n, std::uint64_t seed) {
        return each(n, seed, [](Dice& d) {
            const double x = d.between(0, 1e4);
            return on_ground(x, d.between(0, 1e4));
        });
    };
    const auto far = [](std::size_t n, std::uint64_t seed) {
        return each(n, seed, [](Dice& d) {  // to the centimetre, as surveys are
            const double x = 4.5e5 + static_cast<double>(d.below(100'000)) / 100;
            return on_ground(x, 5.4e6 + static_cast<double>(d.below(100'000)) / 100);
        });
    };
    const auto circle = [](std::size_t n, std::uint64_t seed) {
        return each(n, seed, [](Dice& d) {
            const double turn = d.between(0, 6.283185307179586);
            return on_ground(1e5 + 500 * std::cos(turn), 1e5 + 500 * std::sin(turn));
        });
    };
    const auto lattice_circle = [](std::size_t n, std::uint64_t seed) {
        // All with x^2 + y^2 = 5^2 13^2 17^2, exactly on one circle, and its centre's surroundings.
        Points points;
        for (int x = -1105; x <= 1105; ++x)
            for (int y = -1105; y <= 1105; ++y)
                if (x * x + y * y == 1105 * 1105) points.push_back(on_ground(x, y));
        Dice dice(seed);
        while (points.size() < n)
            points.push_back(on_ground(double(dice.below(60)), double(dice.below(60))));
        return points;
    };
    const auto lines = [](std::size_t n, std::uint64_t seed) {
        return each(n, seed, [](Dice& d) {
            const double along = static_cast<double>(d.below(1000));
            const std::uint64_t line = d.below(4);
            if (line == 0) return on_ground(along, 0);
            if (line == 1) return on_ground(0, along);
            if (line == 2) return on_ground(along, 2 * along);
            return on_ground(500 + along / 8, 250);
        });
    };
    const auto almost_a_line = [](std::size_t n, std::uint64_t seed) {
        return each(n, seed, [](Dice& d) {
            const double x = d.between(1e6, 2e6);
            return on_ground(x, moved(x / 3.0, static_cast<std::int64_t>(d.below(3))));
        });
    };
    const auto ulps = [](std::size_t n, std::uint64_t seed) {
        return each(n, seed, [](Dice& d) {
            const double x =
                moved(4e5 + static_cast<double>(d.below(5)), static_cast<std::int64_t>(d.below(4)));
            return on_ground(x, moved(5e6 + static_cast<double>(d.below(5)),
                                      static_cast<std::int64_t>(d.below(4))));
        });
    };
    return {
        {"scattered", in_box},
        {"centimetres far away", far, true},
        {"grid", [](std::size_t n, std::uint64_t) { return grid(n, 0, 0, 30); }, true},
        {"grid far away", [](std::size_t n, std::uint64_t) { return grid(n, 4.5e5, 5.4e6, 0.1); },
         true},
        {"circle", circle},
        {"lattice circle", lattice_circle, true},
        {"lines", lines, true},
        {"almost a line", almost_a_line, true},
        {"clustered", clustered},
        {"nested", nested},
        {"ulps", ulps, true},
    };
}

}  // namespace

const std::vector<PointCloud>& point_clouds() {
    static const std::vector<PointCloud> clouds = make_clouds();
    return clouds;
}

const PointCloud& point_cloud(const std::string& name) {
    for (const PointCloud& cloud : point_clouds())
        if (cloud.name == name) return cloud;
    throw std::invalid_argument("no cloud of points is called " + name);
}

}  // namespace tinsmith::test
