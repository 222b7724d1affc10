// SPDX-License-Identifier: Apache-2.0
#include "tests/support/guarantees.hpp"

#include <iterator>

#include "core/mesh/check.hpp"

namespace tinsmith::test {

std::vector<std::string> check_valid(const core::Tin& tin) {
    std::vector<std::string> broken;
    for (const auto& violation : core::check_tin(tin, 5))
        broken.push_back("G1 " + violation.law + ": " + violation.detail);
    return broken;
}

std::vector<std::string> check_guarantees(verify::Verifier& verifier, const Operation& op,
                                          std::size_t forced) {
    std::vector<std::string> broken = check_valid(op.after);
    double certified = 0.0;
    for (const auto& shape : op.report.shapes)
        certified += shape.max_vertical_deviation;
    auto found = verifier.step(op.after.to_data(), op.shapes, op.options, certified, forced);
    std::move(found.begin(), found.end(), std::back_inserter(broken));
    return broken;
}

}  // namespace tinsmith::test
