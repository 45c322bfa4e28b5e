#pragma once
// A drive's parameters as a file: what `taktwerk drive save` writes and `restore` and `diff` read. Values as the manual shows them,
// with units; names as the manual has them.

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "axes/port/drive_profile.hpp"
#include "core/result.hpp"

namespace taktwerk::config {

struct ParameterSet {
    struct Value {
        const axes::DriveParameter* parameter = nullptr;  ///< of the profile it was read for
        std::int64_t raw = 0;
    };
    std::string drive;    ///< profile name
    std::string comment;  ///< where it comes from, for people
    std::vector<Value> values;
};

/// As YAML, in the order of the values, each with its name in a comment. The result reads back to the same set.
[[nodiscard]] std::string text_of(const ParameterSet& set);

/// All problems at once: another drive's set, unknown names, values out of range, commands that a set must not hold.
[[nodiscard]] std::variant<ParameterSet, std::vector<Error>> read_parameter_set(const std::string& path, const axes::DriveProfile& profile);
[[nodiscard]] std::variant<ParameterSet, std::vector<Error>> parse_parameter_set(const std::string& path, std::string_view text,
                                                                                 const axes::DriveProfile& profile);

}  // namespace taktwerk::config
