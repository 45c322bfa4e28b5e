#include "apps/machine/path_remarks.hpp"

#include <fmt/format.h>

#include "fb_library/gcode/fault.hpp"
#include "fb_library/gcode/interpreter.hpp"
#include "fb_library/gcode/text_source.hpp"

namespace taktwerk::apps {

std::vector<Error> path_remarks(std::span<const runtime::PathConfig> paths) {
    std::vector<Error> all;
    for (const auto& path : paths) {
        if (path.text == nullptr) continue;
        gcode::TextInMemory text(*path.text);
        gcode::Interpreter program(text, path.options);
        gcode::ProgramItem item;
        auto step = program.next(item);
        while (step == gcode::Interpreter::Step::item) step = program.next(item);
        if (step != gcode::Interpreter::Step::fault) continue;
        auto fault = gcode::fault_error(program.fault(), path.file);
        fault.what = fmt::format("{} (path {}: MC_PathSelect refuses it)", fault.what, path.name);
        all.push_back(std::move(fault));
    }
    return all;
}

}  // namespace taktwerk::apps
