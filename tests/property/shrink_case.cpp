// SPDX-License-Identifier: Apache-2.0
// shrink_case SEED [NOTE...]: the smallest case found that fails like the seed of the property
// tests, on standard output, each note a line of it. shrink_case FILE [NOTE...] takes a case file.
#include <algorithm>
#include <iostream>
#include <string>

#include "tests/support/laws.hpp"
#include "tests/support/random_case.hpp"
#include "tests/support/shrink.hpp"
#include "tests/support/trial.hpp"

namespace {

using namespace tinsmith::test;

bool is_number(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// The seed's requests up to the first that fails; the first alone where none does.
Case case_of_seed(std::uint64_t seed) {
    RandomCase random(seed);
    Case result;
    result.mesh = random.mesh();
    Trial trial(result.mesh);
    while (trial.broken().empty() && random.more()) {
        result.requests.push_back(random.next(trial.mesh()));
        if (!trial.apply(result.requests.back()).broken.empty()) return result;
    }
    result.requests.resize(std::min<std::size_t>(result.requests.size(), 1));
    return result;
}

/// The first fault of the case: of a guarantee, else of a law between two integrations of its only
/// request.
std::string fault_of(const Case& given) {
    const Verdict verdict = replay(given);
    if (!verdict.broken.empty()) return verdict.broken.front();
    const Trial trial(given.mesh);
    if (given.requests.size() != 1 || !trial.broken().empty()) return {};
    const auto broken = check_laws(trial.tin(), given.requests.front());
    return broken.empty() ? std::string() : broken.front();
}

std::string word_of(const std::string& fault) {
    return fault.substr(0, fault.find_first_of(" :"));
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::cerr << "usage: shrink_case SEED|FILE [NOTE...]\n";
        return 2;
    }
    const std::string which = words[1];
    const Case given = is_number(which) ? case_of_seed(std::stoull(which)) : read_case_file(which);
    const std::string fault = fault_of(given);
    if (fault.empty()) {
        std::cerr << which << " does not fail\n";
        return 1;
    }
    Case smallest = shrink(given, [&](const Case& candidate) {
        return word_of(fault_of(candidate)) == word_of(fault);
    });
    const std::string left = fault_of(smallest);
    smallest.notes.assign(words + 2, words + count);
    smallest.notes.push_back("when found: " + left);
    write_case(std::cout, smallest);
    std::cerr << given.mesh.triangles.size() << " triangles and " << given.requests.size()
              << " requests became " << smallest.mesh.triangles.size() << " and "
              << smallest.requests.size() << "; " << left << '\n';
    return 0;
}
