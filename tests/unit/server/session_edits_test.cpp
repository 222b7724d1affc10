// SPDX-License-Identifier: Apache-2.0
// Edits in random histories, with a session that was given what remains as the oracle.
#include <atomic>
#include <map>

#include <gtest/gtest.h>

#include "core/mesh/build.hpp"
#include "core/mesh/check.hpp"
#include "core/regions/region.hpp"
#include "server/edit_making.hpp"
#include "server/session.hpp"
#include "tests/support/random_input.hpp"
#include "tests/support/same_tin.hpp"

namespace tinsmith::server {
namespace {

using test::MeshKind;
using test::pick;
using test::Random;
using test::ShapeKind;
using test::uniform;

const std::atomic<bool> kNotStopping{false};

/// A request as the test remembers it: polygons, or an edit.
struct Made {
    std::vector<core::Shape> shapes = {};
    std::vector<std::string> ids = {};
    core::IntegrateOptions options = {};
    std::optional<api::EditRequest> edit = {};
};

using Done = std::variant<std::vector<std::string>, std::string>;  ///< ids, or why not

Done do_request(Session& session, const Made& made, bool dry_run = false) {
    if (!made.edit) {
        PolygonEdit edit;
        edit.origins.resize(made.shapes.size());
        edit.shapes = made.shapes;
        edit.options = made.options;
        edit.dry_run = dry_run;
        const auto outcome = session.integrate(std::move(edit));
        if (const auto* result = std::get_if<PolygonResult>(&outcome)) return result->polygon_ids;
        return "polygons refused";
    }
    auto edit = make_edit(session, *made.edit, Limits{}, kNotStopping);
    if (auto* no = std::get_if<NoEdit>(&edit)) return "no edit " + std::to_string(no->index());
    std::get<PendingEdit>(edit).dry_run = dry_run;
    const auto outcome = session.edit(std::move(std::get<PendingEdit>(edit)));
    if (std::holds_alternative<EditResult>(outcome)) return std::vector<std::string>{};
    if (const auto* errors = std::get_if<core::Errors>(&outcome))
        return std::string(core::code_name(errors->front().code));
    return "not there";
}

class RandomEdits {
  public:
    explicit RandomEdits(std::uint64_t seed) : random_(seed) {
        const auto kind = static_cast<MeshKind>(pick(random_, test::kMeshKinds));
        while (mesh_.triangles.size() < 2)
            mesh_ = test::random_mesh(random_, kind, 2 + pick(random_, 4));
        session_.emplace(facts(), std::move(core::build_tin(mesh_).value()));
        const core::Bounds& box = session_->view().bounds;
        size_ = std::max(box.max.x - box.min.x, box.max.y - box.min.y);
    }

    void step() {
        switch (pick(random_, 10)) {
            case 0:
            case 1:
                return undo();
            case 2:
                return redo();
            case 3:
                return remove(false);
            case 4:
                return remove(true);
            case 5:
            case 6:
                return add(random_polygons());
            default:
                return add(random_edit());
        }
    }

    /// Empty: the mesh is whole, and that of a session which was given what remains.
    std::string compare() {
        const core::Tin tin = session_->copy_tin();
        const auto broken = core::check_tin(tin);
        if (!broken.empty()) return broken[0].law + ": " + broken[0].detail;
        if (session_->view().version != version_) return "another version";
        Session fresh(facts(), std::move(core::build_tin(mesh_).value()));
        std::map<std::string, std::string> names;  // ids are given anew there
        for (Made made : now_) {
            if (made.edit) made.edit->polygon = names[made.edit->polygon];
            const Done done = do_request(fresh, made);
            if (const auto* why = std::get_if<std::string>(&done))
                return "an operation that remains is refused: " + *why;
            for (std::size_t i = 0; i < made.ids.size(); ++i)
                names[made.ids[i]] = std::get<0>(done)[i];
        }
        if (session_->view().polygons != names.size()) return "another number of polygons";
        if (!test::same_tin(tin, fresh.copy_tin())) return "another mesh";
        // What is told of the polygons is that of the other, too.
        const auto ours = session_->draped(), theirs = fresh.draped();
        for (std::size_t i = 0; i < ours.polygons.size(); ++i) {
            const auto &l = ours.polygons[i].region, &r = theirs.polygons[i].region;
            if (l.has_value() != r.has_value() || (l && l->plan_area != r->plan_area))
                return "another area";
        }
        return "";
    }

    std::map<std::string, int> counts;

  private:
    static SessionFacts facts() { return {"s", "b", "", "", "metre"}; }

    Made random_polygons() {
        Made made;
        const int count = 1 + pick(random_, 2);
        for (int i = 0; i < count; ++i) {
            constexpr ShapeKind kKinds[] = {
                ShapeKind::Ring,  ShapeKind::Ring,   ShapeKind::Tangled, ShapeKind::Holed,
                ShapeKind::Rings, ShapeKind::Around, ShapeKind::Lattice, ShapeKind::AlongEdges};
            made.shapes.push_back(
                test::random_shape(random_, kKinds[random_() % std::size(kKinds)], mesh_));
            for (core::Path& path : made.shapes.back().paths)
                path.closed = true;
        }
        made.options.improve = static_cast<core::Improve>(pick(random_, 3));
        return made;
    }

    Made random_edit() {
        api::EditRequest edit;
        edit.operation = static_cast<api::EditKind>(pick(random_, 5));
        std::vector<std::string> known;
        for (const Made& made : now_)
            known.insert(known.end(), made.ids.begin(), made.ids.end());
        if (known.empty() || pick(random_, 20) == 0) known = {"p99"};  // there is none
        edit.polygon = known[random_() % known.size()];
        edit.plane = core::level_plane(uniform(random_, -5, 5));
        edit.by = uniform(random_, -1, 1);
        edit.passes = 1 + random_() % 4;
        edit.moves_border = pick(random_, 3) == 0;
        if (edit.operation == api::EditKind::Set || edit.operation == api::EditKind::Offset) {
            if (!edit.moves_border && pick(random_, 2) == 0) {
                edit.taper = size_ * uniform(random_, 0.001, 0.2);
                edit.moves_border = true;
            } else if (!edit.moves_border) {
                edit.rim = size_ * uniform(random_, 0.0001, 0.02);
            }
        }
        Made made;
        made.edit = edit;
        return made;
    }

    /// Empty: an edit that leaves the border alone changed nothing that is not inside, by a bit.
    std::string compare_outside(const core::Tin& before,
                                const std::vector<core::TriangleId>& inside) {
        const core::Tin after = session_->copy_tin();
        for (std::uint32_t t = 0; t < before.triangle_count(); ++t) {
            if (std::binary_search(inside.begin(), inside.end(), core::TriangleId{t})) continue;
            const auto& corners = before.triangle({t}).vertices;
            if (after.triangle({t}).vertices != corners) return "another triangle outside";
            for (const core::VertexId v : corners)
                if (after.vertex(v).point() != before.vertex(v).point())
                    return "a vertex that is not inside has moved";
        }
        return "";
    }

    std::vector<core::TriangleId> inside(const std::string& id) {
        return session_->look(
            [&id](const core::Tin& tin, const std::vector<Polygon>& polygons, std::uint64_t) {
                for (const Polygon& polygon : polygons) {
                    if (polygon.id() != id) continue;
                    const core::ShapeReport& own = polygon.own_report();
                    return core::find_region(tin, core::ConstraintHistory(tin),
                                             {polygon.outline(), own.chains, own.outside},
                                             polygon.request.winding)
                        .triangles;
                }
                return std::vector<core::TriangleId>{};
            });
    }

    void add(Made made) {
        const core::Tin before = session_->copy_tin();
        const auto region =
            made.edit ? inside(made.edit->polygon) : std::vector<core::TriangleId>{};
        const Done tried = do_request(*session_, made, true);
        EXPECT_TRUE(test::same_tin(before, session_->copy_tin())) << "a dry run changes nothing";
        Done done = do_request(*session_, made);
        EXPECT_EQ(tried.index(), done.index());
        const std::string kind =
            made.edit ? std::string(api::edit_name(made.edit->operation)) : "polygons";
        if (done.index() == 1) {
            EXPECT_TRUE(test::same_tin(before, session_->copy_tin())) << "an error changes nothing";
            ++counts[kind + " " + std::get<1>(done)];
            return;
        }
        ++counts[kind];
        const bool is_bounded = made.edit && !made.edit->moves_border &&
                                (made.edit->rim || made.edit->operation == api::EditKind::Smooth);
        if (is_bounded) {
            EXPECT_EQ(compare_outside(before, region), "") << kind;
            ++counts["bounded"];
        }
        made.ids = std::get<0>(std::move(done));
        past_.push_back(now_);
        future_.clear();
        now_.push_back(std::move(made));
        ++version_;
    }

    void undo() {
        const bool done = std::holds_alternative<ChangeResult>(session_->undo({}));
        EXPECT_EQ(done, !past_.empty());
        if (!done) return;
        future_.push_back(std::exchange(now_, past_.back()));
        past_.pop_back();
        ++version_;
        ++counts["undo"];
    }

    void redo() {
        const bool done = std::holds_alternative<ChangeResult>(session_->redo({}));
        EXPECT_EQ(done, !future_.empty());
        if (!done) return;
        past_.push_back(std::exchange(now_, future_.back()));
        future_.pop_back();
        ++version_;
        ++counts["redo"];
    }

    void remove(bool cascade) {
        std::vector<std::pair<std::size_t, std::size_t>> known;
        for (std::size_t m = 0; m < now_.size(); ++m)
            for (std::size_t i = 0; i < now_[m].ids.size(); ++i)
                known.emplace_back(m, i);
        if (known.empty()) return;
        const auto [m, i] = known[random_() % known.size()];
        const std::string id = now_[m].ids[i];
        const auto names_it = [&id](const Made& made) {
            return made.edit && made.edit->polygon == id;
        };
        const auto users = std::count_if(now_.begin(), now_.end(), names_it);
        const auto outcome = session_->remove_polygon(id, cascade, {});
        if (const auto* in_use = std::get_if<PolygonInUse>(&outcome)) {
            EXPECT_FALSE(cascade);
            EXPECT_EQ(static_cast<std::ptrdiff_t>(in_use->versions.size()), users);
            ++counts["in use"];
            return;
        }
        EXPECT_TRUE(cascade || users == 0);
        if (!std::holds_alternative<ChangeResult>(outcome)) {
            EXPECT_TRUE(std::holds_alternative<ReplayFailure>(outcome));
            ++counts["replay failed"];
            return;
        }
        past_.push_back(now_);
        future_.clear();
        Made& made = now_[m];
        made.shapes.erase(made.shapes.begin() + static_cast<std::ptrdiff_t>(i));
        made.ids.erase(made.ids.begin() + static_cast<std::ptrdiff_t>(i));
        std::erase_if(now_, [&](const Made& each) {
            return names_it(each) || (!each.edit && each.ids.empty());
        });
        ++version_;
        ++counts[users > 0 ? "removed with edits" : "removed"];
    }

    Random random_;
    core::MeshData mesh_;
    std::optional<Session> session_;
    double size_ = 1.0;
    std::uint64_t version_ = 1;
    std::vector<Made> now_;
    std::vector<std::vector<Made>> past_;
    std::vector<std::vector<Made>> future_;
};

TEST(SessionEdits, LeaveTheMeshOfAFreshSessionAfterAnyWayBackAndForth) {
    const char* only = std::getenv("TINSMITH_SEED");
    const std::uint64_t first = only != nullptr ? std::strtoull(only, nullptr, 10) : 1;
    const std::uint64_t last = only != nullptr ? first : 300;
    std::map<std::string, int> counts;
    for (std::uint64_t seed = first; seed <= last; ++seed) {
        RandomEdits history(seed);
        for (int i = 0; i < 16; ++i) {
            history.step();
            const std::string difference = history.compare();
            ASSERT_EQ(difference, "") << "TINSMITH_SEED=" << seed << ", step " << i;
        }
        for (const auto& [what, count] : history.counts)
            counts[what] += count;
    }
    for (const auto& [what, count] : counts)
        std::printf("%s: %d\n", what.c_str(), count);
    if (only != nullptr) return;
    for (const char* what : {"set", "offset", "smooth", "remove", "keep", "undo", "redo", "removed",
                             "removed with edits", "in use", "polygons", "bounded"})
        EXPECT_GT(counts[what], 40) << what;
}

}  // namespace
}  // namespace tinsmith::server
