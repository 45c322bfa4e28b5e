#pragma once
// What is wrong, for scripts.

#include <vector>

#include <nlohmann/json.hpp>

#include "core/result.hpp"

namespace taktwerk::apps {

/// [{"code","subject","what","remedy"}]
[[nodiscard]] inline nlohmann::ordered_json problems_json(const std::vector<Error>& errors) {
    auto all = nlohmann::ordered_json::array();
    for (const auto& error : errors)
        all.push_back({{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}});
    return all;
}

/// In the place of a result on standard output: {"ok":false,"errors":[...]}.
[[nodiscard]] inline nlohmann::ordered_json failure_json(const std::vector<Error>& errors) {
    return {{"ok", false}, {"errors", problems_json(errors)}};
}

}  // namespace taktwerk::apps
