#include "apps/machine/checked_machine.hpp"

#include <thread>

#include "apps/machine/load.hpp"
#include "apps/machine/path_remarks.hpp"
#include "core/installed_memory.hpp"
#include "hmi_bridge/modbus/offer.hpp"
#include "hmi_bridge/modbus/shown_value.hpp"
#include "hmi_bridge/views/view_check.hpp"
#include "runtime/check/machine_remarks.hpp"
#include "runtime/check/recording_memory.hpp"
#include "runtime/tasks/borrowed_rights.hpp"

namespace taktwerk::apps {

std::variant<CheckedMachine, std::vector<Error>> check_machine(const std::string& file) {
    // It loads what it checks, and what is loaded runs: with the rights of whoever asked, and no others.
    if (auto ok = runtime::give_back_rights(); !ok) return std::vector<Error>{ok.error()};
    auto result = read_machine(file, false);
    if (auto* errors = std::get_if<std::vector<Error>>(&result)) return std::move(*errors);
    auto& loaded = std::get<LoadedFile>(result);
    CheckedMachine out{loaded.machine, std::move(loaded.hmi), std::move(loaded.warnings), {}, std::move(loaded.files), {}, {}};

    // Building the machine loads the programs and compares what they declare; nothing is started, and what a running machine keeps stays its.
    loaded.machine.retain.directory.clear();
    out.world = std::make_unique<runtime::World>(out.config, Instant{});
    auto built =
        runtime::Machine::build(std::move(loaded.machine), out.world->bus(), out.world->serial().lines(), out.world->modbus().exchanges());
    if (auto* errors = std::get_if<std::vector<Error>>(&built)) return std::move(*errors);
    out.machine = std::move(std::get<0>(built));
    const auto& layout = out.machine->layout();
    // What programs have is known only now.
    const auto& served = out.hmi.modbus_server;
    auto of_programs = served ? hmi::check(*served, hmi::names_of(layout)) : std::vector<Error>{};
    const auto of_views = hmi::check(out.hmi.views, hmi::view_values_of(out.config, layout));
    of_programs.insert(of_programs.end(), of_views.begin(), of_views.end());
    if (!of_programs.empty()) return of_programs;
    out.remarks = runtime::remarks(out.config, layout, std::thread::hardware_concurrency());
    const auto of_paths = path_remarks(out.config.paths);
    out.remarks.insert(out.remarks.end(), of_paths.begin(), of_paths.end());
    if (auto large = runtime::recording_remark(out.config.recording.depth, out.machine->signals().bytes(), installed_memory()))
        out.remarks.push_back(std::move(*large));
    return out;
}

}  // namespace taktwerk::apps
