// SPDX-License-Identifier: Apache-2.0
#include "tests/support/trial.hpp"

#include "core/integrate/integrator.hpp"
#include "core/mesh/build.hpp"
#include "tests/support/guarantees.hpp"
#include "tests/support/same_bytes.hpp"

namespace tinsmith::test {

using core::ErrorCode;
using core::MeshData;

std::string Verdict::kind() const {
    return broken.empty() ? "" : broken.front().substr(0, broken.front().find_first_of(" :"));
}

Trial::Trial(const MeshData& mesh) {
    auto built = core::build_tin(mesh);
    if (!built) {
        broken_.push_back("MESH was refused: " + built.errors()[0].detail);
        return;
    }
    tin_ = std::move(*built);
    verifier_.emplace(tin_->to_data());
}

Verdict Trial::apply(const Request& request) {
    Verdict verdict;
    const auto report = core::integrate(*tin_, request.shapes, request.options);
    if (!report) {
        verdict.refused = true;
        const ErrorCode code = report.errors()[0].code;
        const bool may_leave =
            code == ErrorCode::LeavesMesh && request.options.outside == core::Outside::Reject;
        if (!same_bytes(verifier_->mesh(), tin_->to_data()))
            verdict.broken.push_back("G6 a refused request changed the mesh");
        else if (code != ErrorCode::OutsideMesh && !may_leave)
            verdict.broken.push_back(std::string(code_name(code)) + ": " +
                                     report.errors()[0].detail);
        return verdict;
    }
    verdict.broken =
        check_guarantees(*verifier_, {request.shapes, request.options, *report, *tin_});
    return verdict;
}

Verdict replay(const Case& replayed) {
    Trial trial(replayed.mesh);
    Verdict verdict;
    verdict.broken = trial.broken();
    for (const Request& request : replayed.requests) {
        if (!verdict.broken.empty()) break;
        verdict = trial.apply(request);
    }
    return verdict;
}

}  // namespace tinsmith::test
