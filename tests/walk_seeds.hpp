#pragma once
// One random walk after the other, seed by seed. TAKTWERK_WALK_SEED=<seed> runs one alone and tells all that was asked in it;
// TAKTWERK_WALK_FAILURES=<n> goes on until n of them have failed; TAKTWERK_WALK_FIRST=<seed> begins there, with as many as ever.

#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/property_cases.hpp"

namespace taktwerk::test {

struct WalkedSeeds {
    unsigned first = 1;
    long walks = 0;
    bool one_alone = false;  ///< what all of them together must have seen, it need not
};

/// `usual`: seeds in every test run. `make(seed)`: a walk with run(length), which says what went wrong, and log(). `after(walk)`: of each.
template <class Make, class After>
WalkedSeeds walk_seeds(unsigned usual, int length, Make make, After after) {
    WalkedSeeds walked;
    const char* only = std::getenv("TAKTWERK_WALK_SEED");
    walked.one_alone = only != nullptr;
    if (only) walked.first = static_cast<unsigned>(std::strtoul(only, nullptr, 10));
    else if (const char* first = std::getenv("TAKTWERK_WALK_FIRST")) walked.first = static_cast<unsigned>(std::strtoul(first, nullptr, 10));
    const unsigned last = only ? walked.first : walked.first + static_cast<unsigned>(property_cases(usual)) - 1;
    const char* most = std::getenv("TAKTWERK_WALK_FAILURES");
    int failures = most ? std::atoi(most) : 1;
    for (unsigned seed = walked.first; seed <= last && failures > 0; ++seed) {
        auto walk = make(seed);
        walk.logs = walked.one_alone;
        const auto wrong = walk.run(length);
        if (!wrong.empty()) {
            ADD_FAILURE() << "seed " << seed << "\n" << wrong << walk.log();
            --failures;
        }
        ++walked.walks;
        after(walk);
    }
    return walked;
}

}  // namespace taktwerk::test
