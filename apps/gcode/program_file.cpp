#include "apps/gcode/program_file.hpp"

#include <sys/stat.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "core/one_line.hpp"

namespace taktwerk::apps {
namespace {

std::optional<double> whole_number_text(std::string_view text) {
    double value = 0;
    const auto [end, wrong] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (wrong != std::errc{} || end != text.data() + text.size() || !(std::fabs(value) <= 1e6)) return std::nullopt;
    return value;
}

/// "x,y,z" in mm.
std::optional<gcode::AxisValues> three_values(std::string_view text) {
    gcode::AxisValues values{};
    for (std::size_t axis = 0; axis < gcode::linear_axes; ++axis) {
        const auto comma = text.find(',');
        if ((comma == std::string_view::npos) != (axis + 1 == gcode::linear_axes)) return std::nullopt;
        const auto value = whole_number_text(text.substr(0, comma));
        if (!value) return std::nullopt;
        values[axis] = *value;
        text.remove_prefix(comma == std::string_view::npos ? text.size() : comma + 1);
    }
    return values;
}

std::optional<gcode::ToolEntry> tool_of(std::string_view text) {
    const auto equals = text.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    gcode::ToolEntry tool;
    const auto name = text.substr(0, equals), offset = text.substr(equals + 1);
    const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), tool.number);
    if (wrong != std::errc{} || end != name.data() + name.size() || tool.number == 0 || tool.number > 99'999) return std::nullopt;
    if (offset.find(',') == std::string_view::npos) {
        const auto length = whole_number_text(offset);
        if (!length) return std::nullopt;
        tool.offset[2] = *length;
        return tool;
    }
    const auto values = three_values(offset);
    if (!values) return std::nullopt;
    tool.offset = *values;
    return tool;
}

constexpr std::array<std::string_view, gcode::coordinate_systems> systems{"G54", "G55",   "G56",   "G57",  "G58",
                                                                          "G59", "G59.1", "G59.2", "G59.3"};

}  // namespace

Result<std::unique_ptr<ProgramFile>> ProgramFile::open(const std::string& path) {
    auto* file = std::fopen(path.c_str(), "re");
    if (!file)
        return Error{"gcode.open", shown_name(path), fmt::format("the program cannot be opened: {}", std::strerror(errno)),
                     "Check its name and its rights."};
    struct stat about {};
    if (::fstat(::fileno(file), &about) == 0 && S_ISDIR(about.st_mode)) {
        std::fclose(file);
        return Error{"gcode.open", shown_name(path), "it is a folder", "Name a file in it."};
    }
    return std::unique_ptr<ProgramFile>(new ProgramFile(file));
}

ProgramFile::~ProgramFile() { std::fclose(file_); }

gcode::TextPiece ProgramFile::read(std::span<char> into) noexcept {
    const auto bytes = std::fread(into.data(), 1, into.size(), file_);
    if (bytes > 0) return {gcode::TextState::some, bytes};
    return {std::ferror(file_) != 0 ? gcode::TextState::failed : gcode::TextState::end, 0};
}

bool ProgramFile::again() noexcept { return std::fseek(file_, 0, SEEK_SET) == 0; }

void add_program_options(CLI::App& sub, ProgramOptions& options) {
    sub.add_option("FILE", options.file, "the program")->required();
    sub.add_option("--tool", options.tools,
                   "a tool for G43: its number and its length in mm, or its offset; --tool 5=120.5, --tool 6=0,1.5,98")
        ->type_name("N=LENGTH|N=X,Y,Z");
    sub.add_option("--offset", options.offsets, "the zero of a coordinate system in machine coordinates, in mm; --offset G55=100,0,-20")
        ->type_name("G54=X,Y,Z");
    sub.add_flag("--rotary", options.rotary, "A, B and C are axes, in degrees; else they are refused");
    sub.add_flag("--inch", options.inch, "numbers are inches until G20 or G21; else millimetres");
    sub.add_flag("--block-delete", options.block_delete, "leave out blocks that begin with /");
    sub.add_option("--from-line", options.from_line, "start at this line of the file, with the state that those before it make")
        ->check(CLI::Range(1u, 1'000'000'000u))
        ->type_name("LINE");
}

Result<gcode::InterpreterOptions> interpreter_options(const ProgramOptions& options) {
    using gcode::InterpreterOptions;
    InterpreterOptions out;
    for (const auto& text : options.tools) {
        const auto tool = tool_of(text);
        if (!tool)
            return Error{"usage.tool", "--tool " + on_one_line(text), "this is no tool",
                         "Write its number and its length in mm, as 5=120.5, or its offset, as 5=0,1.5,98."};
        for (const auto& other : out.tools)
            if (other.number == tool->number)
                return Error{"usage.tool", "--tool " + on_one_line(text), "this tool was given before", "Give each tool once."};
        out.tools.push_back(*tool);
    }
    for (const auto& text : options.offsets) {
        const auto equals = text.find('=');
        std::size_t system = 0;
        while (system < systems.size() && text.substr(0, equals) != systems[system]) ++system;
        const auto values = equals == std::string::npos ? std::nullopt : three_values(std::string_view(text).substr(equals + 1));
        if (system == systems.size() || !values)
            return Error{"usage.offset", "--offset " + on_one_line(text), "this is no coordinate system with its zero",
                         "Write it as G54=100,0,-20, in mm; there are G54 to G59, G59.1, G59.2, G59.3."};
        out.offsets[system] = *values;
    }
    out.rotary = options.rotary ? InterpreterOptions::Rotary::offered : InterpreterOptions::Rotary::refused;
    out.units = options.inch ? InterpreterOptions::Units::inch : InterpreterOptions::Units::mm;
    out.block_delete = options.block_delete;
    out.start_line = options.from_line;
    return out;
}

std::string shown_name(const std::string& path) { return on_one_line(path); }

}  // namespace taktwerk::apps
