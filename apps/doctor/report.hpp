#pragma once
// What the doctor says: for people at a terminal, and for scripts.

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "apps/doctor/verdict.hpp"
#include "apps/terminal/text_table.hpp"

namespace taktwerk::apps {

struct Examination {
    Wanted wanted;
    std::string interface;          ///< empty: none was named
    std::vector<Finding> findings;  ///< sorted by cost
    std::optional<Measured> measured;
    Verdict verdict;
};

/// Whether each figure says where it is from.
enum class Sources : std::uint8_t { hidden, shown };
[[nodiscard]] std::string report_text(const Examination& seen, Colours colours, std::size_t width, Sources sources = Sources::hidden);
[[nodiscard]] nlohmann::ordered_json report_json(const Examination& seen);

}  // namespace taktwerk::apps
