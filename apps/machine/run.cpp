// taktwerk run FILE: runs a machine, in real time or in virtual time, on its bus or simulated.
#include <array>
#include <memory>
#include <string>

#include "apps/machine/fence.hpp"
#include "apps/machine/machine_recording.hpp"
#include "apps/machine/recordings_folder.hpp"
#include "apps/machine/run_options.hpp"
#include "apps/taktwerk.hpp"
#include "apps/terminal/duration_option.hpp"
#include "apps/terminal/exit_code.hpp"
#include "apps/terminal/output_files.hpp"
#include "apps/terminal/print_error.hpp"
#include "runtime/check/machine_remarks.hpp"

namespace taktwerk::apps {

using namespace runtime;

namespace {

/// The file or the bundle, whichever was asked for.
Result<void> choose(RunOptions& options, config::LoadOptions& loading) {
    if (options.file.empty() == options.bundle.empty())
        return Error{"usage.run", "run", options.file.empty() ? "nothing is named that shall run" : "a file and a bundle are named",
                     "write `taktwerk run FILE` or `taktwerk run --bundle MACHINE`"};
    const OutputFile outputs[] = {{"--trace", options.trace}, {"--pcap", options.pcap}, {"--record", options.record}};
    if (auto other = output_in_the_way(outputs, std::array{options.file})) return *other;
    if (options.bundle.empty()) return {};
    auto begun = begin_start(BundleStore(bundle_root(options.root)), options.bundle, options.tries, this_host(), deed_now());
    if (!begun) return begun.error();
    options.from_bundle = std::make_shared<BundleRun>(std::move(begun).value());
    const auto& start = options.from_bundle->start();
    for (const auto& remark : start.remarks) print_warning(remark);
    options.file = start.bundle.machine_file().string();
    loading.state_dir = start.state.string();
    return {};
}

}  // namespace

void add_run(CLI::App& app, Action& action) {
    auto* sub = app.add_subcommand("run", "run a machine");
    auto options = std::make_shared<RunOptions>();
    sub->add_option("FILE", options->file, "machine file");
    sub->add_option("--bundle", options->bundle, "instead of a file: the active version of this machine (`taktwerk bundle`)");
    sub->add_option("--root", options->root, "with --bundle: where bundles are; default: $STATE_DIRECTORY, else /var/lib/taktwerk");
    sub->add_option("--tries", options->tries, "with --bundle: starts that may fail before the version before is taken again")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    sub->add_flag("--simulate", options->simulate, "simulated bus and drives, whatever the file says");
    sub->add_flag("--virtual-time", options->virtual_time, "as fast as the CPU allows, bit-identical each time (simulated only)");
    add_duration(*sub, "--duration", options->duration_s, "machine time, e.g. 60s; default: until stopped");
    sub->add_option("--retain", options->retain,
                    "keep variables, parameters and positions over a time without power in this directory, also on a simulated bus");
    sub->add_option("--start", options->start, "which kept values it begins with: warm: all (default); cold: persistent ones; origin: none")
        ->check(CLI::IsMember({"warm", "cold", "origin"}));
    sub->add_option("--trace", options->trace, "write every cycle to this CSV file (see `taktwerk plot`)");
    sub->add_option("--pcap", options->pcap, "write every frame of the bus to this file, for Wireshark and tshark");
    sub->add_option("--record", options->record, "write everything that comes in to this file, for `taktwerk replay`");
    sub->add_option("--record-size", options->record_size,
                    "begin a further part (FILE.2, FILE.3 before the ending) where one gets larger than this: 500MB")
        ->transform(CLI::AsSizeValue(true));
    sub->add_option("--record-disk", options->record_disk, "the recording ends where all its parts are as large as this: 20GB")
        ->transform(CLI::AsSizeValue(true));
    sub->add_option("--evidence", options->evidence,
                    "write what was on the bus around each alarm that stops something into this directory, also on a simulated bus");
    auto* hmi = sub->add_flag(
        "--hmi{}", options->hmi,
        "serve the page as well, by a process of its own: --hmi=ADDRESS:PORT, default 127.0.0.1 and port 8080 or the next free one");
    sub->add_flag("--no-events", options->without_events, "what stands under `simulation: events` does not happen");
    sub->add_option("--recordings", options->recordings,
                    "keep the seconds around each alarm that stops something in this directory, also of a simulated machine");
    sub->add_option("--history", options->history, "keep the alarms in this directory, also in virtual time");
    sub->add_flag("--json", options->json, "events as one JSON object a line");
    sub->add_flag("--quiet", options->quiet, "say only errors and what clients change");
    sub->callback([&action, options, hmi] {
        options->with_hmi = hmi->count() > 0;
        action = [options] {
            if (options->with_hmi && options->virtual_time) {
                print_error(Error{"usage.hmi", "--hmi", "a machine in virtual time has no page: its seconds are nobody's",
                                  "Leave out --virtual-time."});
                return static_cast<int>(exit_usage);
            }
            const config::FilesRead read;
            auto loading = load_options(options->simulate || options->virtual_time);
            if (const auto chosen = choose(*options, loading); !chosen) {
                print_error(chosen.error());
                return static_cast<int>(chosen.error().code.starts_with("usage.")      ? exit_usage
                                        : chosen.error().code == "bundle.machine_runs" ? exit_refused
                                                                                       : exit_bad_file);
            }
            // Before programs: they are code of somebody else's, and begin when they are loaded.
            if (!options->virtual_time)
                if (const auto up = fence_machine(); !up && !options->quiet) print_warning(up.error());
            auto loaded = load(options->file, loading);
            if (!loaded) return static_cast<int>(exit_bad_file);
            if (const auto nobody = runtime::nothing_answers(loaded->machine)) {
                print_error(*nobody);
                return static_cast<int>(exit_bad_file);
            }
            loaded->machine.fell_back = options->from_bundle && options->from_bundle->start().fell_back;
            if (options->without_events) loaded->machine.simulation.events.clear();
            if (!options->retain.empty()) loaded->machine.retain.directory = options->retain;
            loaded->machine.retain.start = options->start == "cold"     ? runtime::RetainStart::cold
                                           : options->start == "origin" ? runtime::RetainStart::origin
                                                                        : runtime::RetainStart::warm;
            if (!options->evidence.empty()) loaded->machine.evidence.directory = options->evidence;
            auto& recordings = loaded->machine.recording.directory;
            if (!options->recordings.empty()) recordings = options->recordings;
            else if (recordings.empty() && !options->virtual_time) recordings = usual_recordings(loaded->machine);
            if (!options->history.empty()) loaded->hmi.history.directory = options->history;
            const bool simulated = options->simulate || options->virtual_time;
            auto facts = facts_of(options->file, read, loaded->machine, simulated);
            const int code = options->virtual_time ? run_virtual(std::move(*loaded), *options, std::move(facts))
                                                   : run_real(std::move(*loaded), *options, std::move(facts));
            if (options->from_bundle && (code == exit_ok || options->from_bundle->excused())) options->from_bundle->ended_as_asked();
            return code;
        };
    });
}

}  // namespace taktwerk::apps
