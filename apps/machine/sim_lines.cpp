#include "apps/machine/sim_lines.hpp"

#include <filesystem>

#include <fmt/format.h>

namespace taktwerk::apps {

Result<std::unique_ptr<SimLines>> SimLines::open(const runtime::MachineConfig& machine, runtime::World& world,
                                                 const std::vector<std::string>& links) {
    std::unique_ptr<SimLines> out(new SimLines(world));
    for (const auto& config : machine.serial) {
        auto terminal = modbus::PseudoTerminal::open(config.settings);
        if (!terminal) return terminal.error();
        for (auto* station : world.serial().stations(config.name)) (*terminal)->connect(*station);
        out->lines_.push_back({config.name, (*terminal)->path(), std::move(*terminal)});
    }
    for (const auto& assignment : links)
        if (auto linked = out->link(assignment); !linked) return linked.error();
    return out;
}

Result<void> SimLines::link(const std::string& assignment) {
    const auto equals = assignment.find('=');
    const auto name = assignment.substr(0, equals);
    for (auto& line : lines_) {
        if (equals == std::string::npos || line.name != name) continue;
        const std::filesystem::path path = assignment.substr(equals + 1);
        std::error_code failed;
        // A link that an earlier run left behind gives way; a device or a file does not.
        if (std::filesystem::is_symlink(path, failed)) std::filesystem::remove(path, failed);
        std::filesystem::create_symlink(line.terminal->path(), path, failed);
        if (failed) return Error{"sim.line", path.string(), fmt::format("cannot be made: {}", failed.message()), "choose another path"};
        line.path = path.string();
        links_.push_back(line.path);
        return {};
    }
    std::string names;
    for (const auto& line : lines_) names += (names.empty() ? "" : ", ") + line.name;
    return Error{"sim.line", assignment, "names no serial line of this machine",
                 names.empty() ? "it has none" : fmt::format("write it as LINE=PATH; lines: {}", names)};
}

SimLines::~SimLines() {
    std::error_code ignored;
    for (const auto& path : links_) std::filesystem::remove(path, ignored);
}

void SimLines::step(Instant now) {
    for (auto& line : lines_) {
        line.terminal->cut(world_.serial().is_cut(line.name));
        line.terminal->step(now);
    }
}

void SimLines::add_to(std::vector<pollfd>& waiting) const {
    for (const auto& line : lines_) waiting.push_back({line.terminal->descriptor(), POLLIN, 0});
}

}  // namespace taktwerk::apps
