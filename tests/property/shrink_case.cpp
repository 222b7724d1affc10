// SPDX-License-Identifier: Apache-2.0
// shrink_case SEED [NOTE...]: the smallest case found that fails like the seed of the property
// test, on standard output, each note a line of it. shrink_case FILE [NOTE...] takes a case file.
#include <cstdlib>
#include <iostream>
#include <string>

#include "tests/support/random_case.hpp"
#include "tests/support/shrink.hpp"
#include "tests/support/trial.hpp"

namespace {

using namespace tinsmith::test;

bool is_number(const std::string& text) {
    return !text.empty() && text.find_first_not_of("0123456789") == std::string::npos;
}

/// The seed's requests up to the first that fails.
Case case_of_seed(std::uint64_t seed, Leniency& leniency) {
    RandomCase random(seed);
    leniency = random.leniency();
    Case result;
    result.mesh = random.mesh();
    Trial trial(result.mesh, leniency);
    while (trial.broken().empty() && random.more()) {
        result.requests.push_back(random.next(trial.mesh()));
        if (!trial.apply(result.requests.back()).broken.empty()) break;
    }
    return result;
}

}  // namespace

int main(int count, char** words) {
    if (count < 2) {
        std::cerr << "usage: shrink_case SEED|FILE [NOTE...]\n";
        return 2;
    }
    const std::string which = words[1];
    Leniency leniency;
    const Case given =
        is_number(which) ? case_of_seed(std::stoull(which), leniency) : read_case_file(which);
    const Verdict verdict = replay(given, leniency);
    if (verdict.broken.empty()) {
        std::cerr << which << " does not fail\n";
        return 1;
    }
    Case smallest = shrink(given, [&](const Case& candidate) {
        return replay(candidate, leniency).kind() == verdict.kind();
    });
    const Verdict left = replay(smallest, leniency);
    smallest.notes.assign(words + 2, words + count);
    smallest.notes.push_back("when found: " + left.broken.front());
    write_case(std::cout, smallest);
    std::cerr << given.mesh.triangles.size() << " triangles and " << given.requests.size()
              << " requests became " << smallest.mesh.triangles.size() << " and "
              << smallest.requests.size() << "; " << left.broken.front() << '\n';
    return 0;
}
