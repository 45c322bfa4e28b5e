#include "apps/machine/run_files.hpp"

#include <utility>

#include <fmt/format.h>

#include "apps/terminal/count_text.hpp"
#include "apps/terminal/print_error.hpp"

namespace taktwerk::apps {

namespace {

/// The bus has one tap. Real-time safe.
void tap(void* context, std::span<const std::byte> frame, Instant at, bool outgoing) noexcept {
    const auto& files = *static_cast<const RunFiles*>(context);
    if (files.capture) ecat::FrameCapture::tap(files.capture.get(), frame, at, outgoing);
    if (files.evidence) ecat::FrameMemory::tap(&files.evidence->frames(), frame, at, outgoing);
}

}  // namespace

Result<void> RunFiles::open(runtime::Machine& machine, Duration epoch) {
    if (!pcap.empty()) {
        auto created = ecat::FrameCapture::create(pcap, {machine.layout().interface, {}, epoch});
        if (!created) return created.error();
        capture = std::move(*created);
    }
    if (!machine.config().evidence.directory.empty()) {
        auto opened = runtime::Evidence::open(machine, epoch);
        if (!opened) return opened.error();
        evidence = std::move(*opened);
    }
    if (const auto& wanted = machine.config().recording; !wanted.directory.empty() && wanted.files > 0) {
        auto opened = runtime::FlightRecorder::open(machine, wanted.directory, epoch);
        if (!opened) return opened.error();
        recorder = std::move(*opened);
    }
    if (capture || evidence) machine.bus().set_tap(&tap, this);
    if (!trace_csv.empty()) {
        auto created = TraceCsv::create(trace_csv, machine.signals(), machine.layout());
        if (!created) return created.error();
        trace = std::move(*created);
    }
    return {};
}

Result<void> RunFiles::record(runtime::Machine& machine, const MachineRecording::Wanted& wanted,
                              std::vector<std::pair<std::string, std::string>> facts, Instant start, runtime::RecordedThreads threads) {
    if (wanted.file.path.empty() && !wanted.memory) return {};
    auto created = MachineRecording::create(wanted, machine, std::move(facts), start, threads);
    if (!created) return created.error();
    recording = std::move(*created);
    return {};
}

void RunFiles::look_for_replay(const runtime::Snapshot& snapshot, const runtime::Machine& machine) const {
    if (!recording || recording->memory() == nullptr) return;
    recording->memory()->look(snapshot, [&machine](const AlarmFact& fact) { return machine.describe(fact).name; });
}

void RunFiles::finish_capture() const {
    if (!capture) return;
    if (auto ok = capture->finish(); !ok) print_error(ok.error());
}

void RunFiles::say_frames(bool quiet, const MachineLog::Sink& put) const {
    if (!capture) return;
    if (capture->dropped() > 0)
        print_warning(Error{"capture.dropped", pcap, fmt::format("{} frames did not fit and are missing", capture->dropped()), ""});
    if (!quiet) put(fmt::format("{} frames in {}\n", capture->frames(), pcap));
}

std::string evidence_text(const runtime::Evidence::File& file) {
    if (file.path.empty()) return {};
    return fmt::format("{} of {:.1f} s around {} in {}", count_text(file.frames, "frame"), to_seconds(file.covered),
                       count_text(file.alarms, "alarm"), file.path);
}

std::string recording_text(const runtime::FlightRecorder::File& file) {
    if (file.path.empty()) return {};
    const auto& alarms = file.alarms;
    return fmt::format("{:.1f} s around '{}' of {}{} in {}", to_seconds(file.covered), alarms.front().name, alarms.front().source,
                       alarms.size() > 1 ? fmt::format(" (and {})", count_text(alarms.size() - 1, "further alarm")) : "", file.path);
}

}  // namespace taktwerk::apps
