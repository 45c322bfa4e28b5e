#pragma once
// What a command is told to write must not be what it reads, nor one file twice: a slip of the hand on the command line shall cost no machine file and
// no recording of a fault that came once.

#include <optional>
#include <span>
#include <string>

#include "core/result.hpp"

namespace taktwerk::apps {

struct OutputFile {
    std::string option;  ///< as it was written, such as "--trace"
    std::string path;    ///< empty: none was asked for
};

/// Compares files, whatever they are called. Errors: usage.output.
[[nodiscard]] std::optional<Error> output_in_the_way(std::span<const OutputFile> outputs, std::span<const std::string> inputs);

}  // namespace taktwerk::apps
