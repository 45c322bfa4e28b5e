#pragma once
// What a person writes behind `override`: per cent, which the machine takes as a part.

#include <string>

#include "config/reading/unit_text.hpp"
#include "core/result.hpp"

namespace taktwerk::apps {

/// "30", "30 %" -> 0.3. The machine would refuse what is outside as well, but by its own number: who is told to give 0 to 1 gets one per cent.
/// Errors: those of config::value_in, usage.override.
[[nodiscard]] inline Result<double> override_part(const std::string& text) {
    const auto percent = config::value_in(text, "%");
    if (!percent) return percent.error();
    if (!(*percent >= 0 && *percent <= 100))
        return Error{"usage.override", text, "an override is 0 (halt) to 100 per cent (as commanded)",
                     "Give for example 30; it only slows down."};
    return *percent / 100;
}

}  // namespace taktwerk::apps
