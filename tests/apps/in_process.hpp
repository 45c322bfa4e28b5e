#pragma once
// The command inside the test's own process: what a user types, what comes back.

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "apps/taktwerk.hpp"

namespace taktwerk::apps {

struct Outcome {
    int code = 0;
    std::string out, err;
    [[nodiscard]] nlohmann::ordered_json json() const { return nlohmann::ordered_json::parse(out); }
};

/// `words` without "taktwerk".
inline Outcome in_process(std::vector<std::string> words) {
    words.insert(words.begin(), "taktwerk");
    std::vector<char*> argv;
    for (auto& word : words) argv.push_back(word.data());
    ::testing::internal::CaptureStdout();
    ::testing::internal::CaptureStderr();
    const int code = run(static_cast<int>(argv.size()), argv.data());
    std::fflush(stdout);
    auto out = ::testing::internal::GetCapturedStdout();
    return {code, std::move(out), ::testing::internal::GetCapturedStderr()};
}

inline Outcome drive(std::vector<std::string> words) {
    words.insert(words.begin(), "drive");
    return in_process(std::move(words));
}

}  // namespace taktwerk::apps
