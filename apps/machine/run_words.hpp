#pragma once
// What both ways of `taktwerk run` say and do around a machine.

#include <memory>
#include <vector>

#include "apps/machine/machine_log.hpp"
#include "apps/machine/run_files.hpp"
#include "apps/machine/run_options.hpp"

namespace taktwerk::apps {

/// A run that ends with something machine-wide still standing did not end well. What stands while the machine goes down does not
/// count: then the bus is meant to be silent.
void judge(const runtime::Snapshot* s, int& code);
void print_summary(runtime::Machine& machine, const RunOptions& options, double machine_seconds, double wall_seconds,
                   const MachineLog::Sink& put);
void finish_capture(const RunFiles& files, const RunOptions& options);
void say_losses(const RunFiles& files, const RunOptions& options);
/// False: it is not whole, and why has been told.
bool recording_finished(const RunFiles& files, const RunOptions& options);
/// A file that could not be written is told; the next one is tried all the same.
void say_evidence(const MachineLog& log, Instant now, const Result<runtime::Evidence::File>& file);
void say_recording(const MachineLog& log, Instant now, const Result<runtime::FlightRecorder::File>& file);
/// What could not be written so far; however many there are.
void finish_recordings(const MachineLog& log, Instant now, runtime::FlightRecorder& recorder);
/// What came of the file of --record, and of the run in memory.
void say_recorded(const MachineLog& log, Instant now, MachineRecording& recording, bool quiet);
/// The end of the run in memory, behind that of the file.
void finish_run_memory(const MachineLog& log, Instant now, MachineRecording& recording, bool quiet);
void say_kept(const MachineLog& log, Instant now, const runtime::Machine& machine, const RunOptions& options);
/// Which bundle it is, and why it may be another than the one that was active.
void say_bundle(const MachineLog& log, Instant now, const RunOptions& options);
/// Once; a disk that takes nothing is not asked in every round.
void note_bundle(const MachineLog& log, Instant now, BundleRun& bundle, bool& noted);
std::unique_ptr<runtime::Machine> build_machine(runtime::MachineConfig config, ecat::Transport& transport,
                                                std::vector<modbus::SerialLine*> lines, std::vector<modbus::tcp::Exchange*> exchanges);

}  // namespace taktwerk::apps
