// SPDX-License-Identifier: Apache-2.0
#include "tests/support/shrink.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <utility>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/compact.hpp"
#include "tests/verify/exact.hpp"

namespace tinsmith::test {

using core::Path;
using core::Shape;

namespace {

/// Whether triangles lie over one another, without `build_tin`. Cost: quadratic.
bool overlaps(const core::MeshData& mesh) {
    const auto plan = [&](std::uint32_t v) { return mesh.vertices[v].plan(); };
    for (const auto& t : mesh.triangles) {
        for (const auto& u : mesh.triangles) {
            for (unsigned i = 0; i < 3; ++i) {
                const auto a = plan(t[i]), b = plan(t[(i + 1) % 3]), c = plan(t[(i + 2) % 3]);
                for (unsigned k = 0; k < 3; ++k)
                    if (verify::cross_properly(a, b, plan(u[k]), plan(u[(k + 1) % 3]))) return true;
                const auto p = plan(u[i]);
                if (verify::side_of(a, b, p) > 0 && verify::side_of(b, c, p) > 0 &&
                    verify::side_of(c, a, p) > 0)
                    return true;
            }
        }
    }
    return false;
}

/// Holds the smallest failing case so far and tries smaller ones.
class Shrinker {
  public:
    Shrinker(const Case& given, const std::function<bool(const Case&)>& fails)
        : smallest_(given), fails_(fails) {}

    Case run() {
        start_later();
        // Each pass that ends changed took something away, so that there is an end.
        do {
            changed_ = false;
            drop(smallest_.requests.size(),
                 [](Case& c, std::size_t from, std::size_t to) { erase(c.requests, from, to); });
            for (std::size_t r = 0; r < smallest_.requests.size(); ++r)
                drop_shapes(r);
            drop(smallest_.mesh.constraints.size(), [](Case& c, std::size_t from, std::size_t to) {
                erase(c.mesh.constraints, from, to);
            });
            drop(smallest_.mesh.triangles.size(), [](Case& c, std::size_t from, std::size_t to) {
                erase(c.mesh.triangles, from, to);
                c.mesh = compact(c.mesh);
            });
        } while (changed_);
        round_numbers();
        return smallest_;
    }

  private:
    template <typename Item>
    static void erase(std::vector<Item>& items, std::size_t from, std::size_t to) {
        items.erase(items.begin() + static_cast<std::ptrdiff_t>(from),
                    items.begin() + static_cast<std::ptrdiff_t>(to));
    }

    bool attempt(Case candidate) {
        if (overlaps(candidate.mesh) || !fails_(candidate)) return false;
        smallest_ = std::move(candidate);
        changed_ = true;
        return true;
    }

    /// Tries to start with the mesh that the first requests leave.
    void start_later() {
        while (smallest_.requests.size() > 1) {
            auto tin = core::build_tin(smallest_.mesh);
            if (!tin) return;
            Case later = smallest_;
            const Request& first = smallest_.requests.front();
            static_cast<void>(core::integrate(*tin, first.shapes, first.options));
            later.mesh = tin->to_data();
            later.requests.erase(later.requests.begin());
            if (!attempt(std::move(later))) return;
        }
    }

    /// Takes away runs of items, long ones first.
    template <typename Erase>
    void drop(std::size_t count, const Erase& erase_run) {
        for (std::size_t run = std::max<std::size_t>(count / 2, 1); count > 0; run /= 2) {
            for (std::size_t from = 0; from < count;) {
                const std::size_t to = std::min(from + run, count);
                Case candidate = smallest_;
                erase_run(candidate, from, to);
                if (attempt(std::move(candidate)))
                    count -= to - from;
                else
                    from = to;
            }
            if (run <= 1) break;
        }
    }

    void drop_shapes(std::size_t r) {
        drop(smallest_.requests[r].shapes.size(), [r](Case& c, std::size_t from, std::size_t to) {
            erase(c.requests[r].shapes, from, to);
        });
        for (std::size_t s = 0; s < smallest_.requests[r].shapes.size(); ++s) {
            drop(smallest_.requests[r].shapes[s].paths.size(),
                 [r, s](Case& c, std::size_t from, std::size_t to) {
                     erase(c.requests[r].shapes[s].paths, from, to);
                 });
            for (std::size_t p = 0; p < smallest_.requests[r].shapes[s].paths.size(); ++p)
                drop_points(r, s, p);
        }
    }

    void drop_points(std::size_t r, std::size_t s, std::size_t p) {
        drop(smallest_.requests[r].shapes[s].paths[p].points.size(),
             [r, s, p](Case& c, std::size_t from, std::size_t to) {
                 Path& path = c.requests[r].shapes[s].paths[p];
                 erase(path.points, from, to);
                 if (!path.elevations.empty()) erase(path.elevations, from, to);
             });
        Case open = smallest_;
        bool& closed = open.requests[r].shapes[s].paths[p].closed;
        if (std::exchange(closed, false)) attempt(std::move(open));
    }

    /// Every number of the case, in a fixed order.
    static std::vector<double*> numbers(Case& c) {
        std::vector<double*> found;
        for (auto& v : c.mesh.vertices)
            found.insert(found.end(), {&v.x, &v.y, &v.z});
        for (Request& request : c.requests) {
            for (Shape& shape : request.shapes) {
                for (Path& path : shape.paths) {
                    for (auto& p : path.points)
                        found.insert(found.end(), {&p.x, &p.y});
                    for (double& z : path.elevations)
                        found.push_back(&z);
                }
            }
        }
        return found;
    }

    /// Gives each number as few digits as it can have.
    void round_numbers() {
        const std::size_t count = numbers(smallest_).size();
        for (std::size_t i = 0; i < count; ++i) {
            for (int digits = 0; digits <= 12; digits += digits < 2 ? 1 : 3) {
                Case candidate = smallest_;
                double& value = *numbers(candidate)[i];
                char text[64];
                std::snprintf(text, sizeof text, "%.*g", digits, value);
                const double rounded = digits == 0 ? 0.0 : std::strtod(text, nullptr);
                if (rounded == value) break;
                value = rounded;
                if (attempt(std::move(candidate))) break;
            }
        }
    }

    Case smallest_;
    const std::function<bool(const Case&)>& fails_;
    bool changed_ = false;
};

}  // namespace

Case shrink(const Case& given, const std::function<bool(const Case&)>& fails) {
    return Shrinker(given, fails).run();
}

}  // namespace tinsmith::test
