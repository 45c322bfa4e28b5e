#pragma once
// What `taktwerk run` writes while the machine runs, where that was asked for: frames of the bus, evidence and recordings around alarms, rows of a trace. Shared
// with the threads that write: one that a disk holds outlives everything.

#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/machine/machine_log.hpp"
#include "apps/machine/machine_recording.hpp"
#include "apps/machine/trace_csv.hpp"
#include "core/result.hpp"
#include "core/time.hpp"
#include "ecat/recording/frame_capture.hpp"
#include "runtime/evidence/evidence.hpp"
#include "runtime/flight/flight_recorder.hpp"
#include "runtime/machine/machine.hpp"

namespace taktwerk::apps {

struct RunFiles {
    std::string pcap, trace_csv;  ///< paths; empty: not asked for

    std::shared_ptr<ecat::FrameCapture> capture;
    std::shared_ptr<runtime::Evidence> evidence;
    std::shared_ptr<TraceCsv> trace;
    std::shared_ptr<runtime::FlightRecorder> recorder;
    std::shared_ptr<MachineRecording> recording;  ///< for `replay`

    /// `epoch`: calendar time at machine time 0. Stays where it is until the machine's last cycle. Errors: of the files.
    [[nodiscard]] Result<void> open(runtime::Machine& machine, Duration epoch);
    /// Before the machine's first cycle, where something of it is wanted. Errors: of MachineRecording::create().
    [[nodiscard]] Result<void> record(runtime::Machine& machine, const MachineRecording::Wanted& wanted,
                                      std::vector<std::pair<std::string, std::string>> facts, Instant start,
                                      runtime::RecordedThreads threads);
    /// Service side: alarms behind which the run is kept.
    void look_for_replay(const runtime::Snapshot& snapshot, const runtime::Machine& machine) const;
    /// After the last cycle, and before say_frames(), where no thread writes the capture. Prints what goes wrong.
    void finish_capture() const;
    /// How many frames there are, and a warning where some are missing.
    void say_frames(bool quiet, const MachineLog::Sink& put) const;
};

/// "1,234 frames of 8.2 s around 'slave_lost' in evidence/..."; empty where nothing was written.
[[nodiscard]] std::string evidence_text(const runtime::Evidence::File& file);
/// "12.0 s around 'drive_fault' of axis y (and 2 further alarms) in .../demo-....twscope"; empty where nothing was written.
[[nodiscard]] std::string recording_text(const runtime::FlightRecorder::File& file);

}  // namespace taktwerk::apps
