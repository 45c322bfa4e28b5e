#pragma once
// The lines with which the socket answers a command.

#include <string>

#include "core/result.hpp"

namespace taktwerk::hmi {

/// `id` as JSON: a number, or "null".
[[nodiscard]] std::string accepted_line(const std::string& id);
[[nodiscard]] std::string refusal_line(const std::string& id, const Error& error);

}  // namespace taktwerk::hmi
