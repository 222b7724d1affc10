// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <numbers>
#include <random>
#include <string>

namespace tinsmith::e2e {

/// A rectangle in plan.
struct Extent {
    double min_x = 0;
    double min_y = 0;
    double width = 0;
    double height = 0;
};

/// Numbers that come out the same every time.
class Dice {
  public:
    explicit Dice(std::uint64_t seed) : engine_(seed) {}

    double between(double low, double high) {
        return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1.0p-53);
    }
    int below(int end) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(end)); }
    template <typename List>
    const auto& one_of(const List& list) {
        return *std::next(std::begin(list), below(static_cast<int>(std::size(list))));
    }
    bool chance(double share) { return between(0, 1) < share; }

  private:
    std::mt19937_64 engine_;
};

inline std::string position_text(double x, double y) {
    std::array<char, 80> text{};
    std::snprintf(text.data(), text.size(), "[%.4f,%.4f]", x, y);
    return text.data();
}

/// A simple ring around a place, of so many corners. Its coordinates as GeoJSON has them.
inline std::string ring_text(Dice& dice, double x, double y, double radius, int corners) {
    std::string text;
    std::string first;
    const double turn = dice.between(0, 1);
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * (i + turn) / corners;
        const double away = radius * dice.between(0.6, 1.0);
        const std::string at =
            position_text(x + away * std::cos(angle), y + away * std::sin(angle));
        if (i == 0) first = at;
        text += at + ",";
    }
    return "[" + text + first + "]";
}

inline std::string polygon_text(const std::string& ring) {
    return R"({"type":"Polygon","coordinates":[)" + ring + "]}";
}

/// A grid of posts one unit apart, as the body of a new session.
inline std::string grid_text(Dice& dice, int side, const std::string& name = {}) {
    std::string text = "{" + (name.empty() ? "" : "\"name\":\"" + name + "\",") +
                       R"("grid":{"origin":[0,0],"cell":[1,1],"columns":)" + std::to_string(side) +
                       R"(,"rows":)" + std::to_string(side) + R"(,"elevations":[)";
    for (int i = 0; i < side * side; ++i)
        text += (i > 0 ? "," : "") + std::to_string(dice.below(4000)) + "e-3";
    return text + "]}}";
}

}  // namespace tinsmith::e2e
