// Any bytes as a line of `taktwerk sim`: a fault of the bus or a happening of the machine whose times are none of the past, or an error
// with a sentence.
#include <cmath>
#include <cstdlib>
#include <string_view>

#include "apps/machine/sim_happenings.hpp"
#include "config/machine_file/machine_loader.hpp"
#include "ecat/sim/faults.hpp"

using namespace taktwerk;

namespace {
runtime::MachineConfig machine() {
    config::LoadOptions options;
    options.simulate = true;
    options.resolve_programs = false;
    auto loaded = config::load_machine(TAKTWERK_SOURCE_DIR "/config/machines/demo.yaml", options);
    if (auto* read = std::get_if<config::LoadedMachine>(&loaded)) return std::move(read->machine);
    std::abort();
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const auto demo = machine();
    const std::string_view line{reinterpret_cast<const char*>(data), size};
    const auto fault = ecat::sim::parse_fault(line);
    if (!fault && (fault.error().code.empty() || fault.error().what.empty())) std::abort();
    if (fault && (fault->after < Duration{0} || !std::isfinite(fault->drift_ppm))) std::abort();
    if (fault && fault->time < Duration{0} && fault->kind != ecat::sim::FaultKind::clock_step) std::abort();
    const auto happening = apps::parse_happening(line, demo);
    if (!happening && (happening.error().code.empty() || happening.error().what.empty())) std::abort();
    if (happening && happening->at < Duration{0}) std::abort();
    return 0;
}
