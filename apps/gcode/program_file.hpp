#pragma once
// A G-code file for the reader, and the options of a command that say what it meets: tools, offsets, how it is run.

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>

#include "core/result.hpp"
#include "fb_library/gcode/interpreter_options.hpp"
#include "fb_library/gcode/text_source.hpp"

namespace taktwerk::apps {

class ProgramFile final : public gcode::TextSource {
public:
    /// Errors: gcode.open.
    [[nodiscard]] static Result<std::unique_ptr<ProgramFile>> open(const std::string& path);
    ~ProgramFile() override;
    gcode::TextPiece read(std::span<char> into) noexcept override;
    /// To the beginning. False: it can be read once only (a pipe).
    [[nodiscard]] bool again() noexcept;

private:
    explicit ProgramFile(std::FILE* file) : file_(file) {}
    std::FILE* file_;
};

/// As they are written on the command line.
struct ProgramOptions {
    std::string file;
    std::vector<std::string> tools, offsets;  ///< "5=120.5" or "5=X,Y,Z"; "G54=X,Y,Z"
    bool rotary = false, inch = false, block_delete = false;
    std::uint32_t from_line = 1;
};
void add_program_options(CLI::App& sub, ProgramOptions& options);

/// Errors: usage.tool, usage.offset.
[[nodiscard]] Result<gcode::InterpreterOptions> interpreter_options(const ProgramOptions& options);

/// A file's name as it stands in front of errors: on one line.
[[nodiscard]] std::string shown_name(const std::string& path);

}  // namespace taktwerk::apps
