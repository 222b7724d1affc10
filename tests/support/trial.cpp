// SPDX-License-Identifier: Apache-2.0
#include "tests/support/trial.hpp"

#include <cstring>

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/guarantees.hpp"

namespace tinsmith::test {

using core::ErrorCode;
using core::MeshData;

namespace {

bool same_bytes(const MeshData& a, const MeshData& b) {
    const auto same = [](const auto& l, const auto& r) {
        return l.size() == r.size() &&
               (l.empty() || std::memcmp(l.data(), r.data(), l.size() * sizeof l[0]) == 0);
    };
    return same(a.vertices, b.vertices) && same(a.triangles, b.triangles) &&
           same(a.constraints, b.constraints);
}

void append(std::vector<std::string>& to, std::vector<std::string> more) {
    to.insert(to.end(), more.begin(), more.end());
}

}  // namespace

std::string Verdict::kind() const {
    return broken.empty() ? "" : broken.front().substr(0, broken.front().find_first_of(" :"));
}

Trial::Trial(const MeshData& mesh, Leniency leniency) : leniency_(leniency) {
    auto built = core::build_tin(mesh);
    if (built)
        tin_ = std::move(*built);
    else
        broken_.push_back("MESH was refused: " + built.errors()[0].detail);
}

Verdict Trial::apply(const Request& request) {
    Verdict verdict;
    const MeshData before = tin_->to_data();
    const auto report = core::integrate(*tin_, request.shapes, request.options);
    if (!report) {
        verdict.refused = true;
        const ErrorCode code = report.errors()[0].code;
        verdict.unrepresentable = code == ErrorCode::NotRepresentable && leniency_.unrepresentable;
        if (!same_bytes(before, tin_->to_data()))
            verdict.broken.push_back("G6 a refused request changed the mesh");
        else if (code != ErrorCode::OutsideMesh && !verdict.unrepresentable)
            verdict.broken.push_back(std::string(code_name(code)) + ": " +
                                     report.errors()[0].detail);
        return verdict;
    }
    const SurfaceOracle oracle(before);
    const Operation operation{oracle, *tin_, request.shapes, *report};
    append(verdict.broken, check_valid(*tin_));
    append(verdict.broken, check_shape_kept(operation, 200, 1));
    append(verdict.broken, check_integrated(operation));
    // Facets outlive requests, so only the first one meets the mesh's edges and nothing else.
    if (applied_++ == 0) append(verdict.broken, check_economical(operation, leniency_.forced));
    return verdict;
}

Verdict replay(const Case& replayed, Leniency leniency) {
    Trial trial(replayed.mesh, leniency);
    Verdict verdict;
    verdict.broken = trial.broken();
    for (const Request& request : replayed.requests) {
        if (!verdict.broken.empty()) break;
        verdict = trial.apply(request);
    }
    return verdict;
}

}  // namespace tinsmith::test
