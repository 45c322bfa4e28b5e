#pragma once
// What `taktwerk run` was asked for, and its two ways to do it.

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "apps/machine/bundle_run.hpp"
#include "apps/machine/load.hpp"

namespace taktwerk::apps {

struct RunOptions {
    std::string start = "warm";
    std::string run_before;  ///< what is to be said of it; empty: it ended in order
    std::string file, trace, pcap, record, retain, evidence, recordings, history, hmi;
    bool simulate = false, virtual_time = false, json = false, quiet = false, with_hmi = false, without_events = false;
    double duration_s = 0;
    std::uint64_t record_size = 0, record_disk = 0;  ///< bytes; 0: no bound
    std::string bundle, root;
    unsigned tries = runtime::usual_tries;
    std::shared_ptr<BundleRun> from_bundle{};  ///< with --bundle, once it is chosen
};

/// For the head of a recording (machine_recording.hpp).
using Facts = std::vector<std::pair<std::string, std::string>>;

/// From one thread, as fast as it goes. Both return the exit code.
int run_virtual(LoadedFile loaded, const RunOptions& options, Facts facts);
/// In real time, on its bus or simulated. Behind a run that did not end in order it begins in manual mode.
int run_real(LoadedFile loaded, RunOptions options, Facts facts);

}  // namespace taktwerk::apps
