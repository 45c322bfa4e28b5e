#pragma once
// What is kept, as JSON for people and their scripts: `taktwerk retain export` and `import`.

#include <string>

#include <nlohmann/json.hpp>

#include "core/result.hpp"
#include "runtime/retain/kept.hpp"

namespace taktwerk::apps {

[[nodiscard]] nlohmann::ordered_json json_of(const runtime::Kept& kept);
/// `file` is for messages. Errors: retain.import, with the place and what is wrong there.
[[nodiscard]] Result<runtime::Kept> kept_of_json(const std::string& file, const std::string& text);

}  // namespace taktwerk::apps
