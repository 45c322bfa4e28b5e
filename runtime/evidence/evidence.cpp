#include "runtime/evidence/evidence.hpp"

#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "ecat/recording/pcapng_file.hpp"
#include "runtime/alarms.hpp"
#include "runtime/stamped_name.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view ending = ".pcapng", unfinished = ".part";

std::string words_of(const AlarmText& alarm) {
    std::string text = fmt::format("{}: {} [{}]", alarm.source, alarm.english, alarm.name);
    if (!alarm.cause.empty()) text += "\nwhy: " + alarm.cause;
    if (!alarm.remedy.empty()) text += "\n-> " + alarm.remedy;
    return text;
}

}  // namespace

Evidence::Evidence(const Machine& machine, Duration epoch)
    : machine_(machine),
      config_(machine.config().evidence),
      epoch_(epoch),
      frames_(static_cast<std::size_t>(machine.config().evidence.megabytes) << 20) {}

Result<std::unique_ptr<Evidence>> Evidence::open(const Machine& machine, Duration epoch) {
    const auto& folder = machine.config().evidence.directory;
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed && !fs::is_directory(folder))
        return Error{"evidence.directory", folder, fmt::format("the folder for evidence cannot be made: {}", failed.message()),
                     "choose another one: `evidence: {directory: ...}`, or --evidence"};
    return std::unique_ptr<Evidence>{new Evidence{machine, epoch}};
}

bool Evidence::notice(const AlarmFact& fact, Reaction reaction, Instant since) {
    if (reaction < Reaction::stop_axis) return false;
    // Whoever pressed it knows why, and would push out what nobody knows.
    if (fact.id == id(MachineAlarm::emergency_stop) && fact.a != emergency_stop_unread) return false;
    const auto words = machine_.describe(fact);
    const std::scoped_lock lock{mutex_};
    noticed_.push_back({fact, since, words.name, words_of(words)});
    return true;
}

void Evidence::look(const Snapshot& snapshot) {
    if (snapshot.phase != MachinePhase::running) return;  // at the end the bus is meant to be silent
    alarms_.look(snapshot, [this](const AlarmFact& fact, Reaction reaction, Instant since) { return notice(fact, reaction, since); });
}

std::vector<Evidence::Noticed> Evidence::due(Instant now) {
    {
        const std::scoped_lock lock{mutex_};
        waiting_.insert(waiting_.end(), noticed_.begin(), noticed_.end());
        noticed_.clear();
    }
    if (waiting_.empty() || now < waiting_.front().since + after) return {};
    if (has_written_ && now < last_written_ + apart) return {};
    return waiting_;
}

Result<Evidence::File> Evidence::write_due(Instant now) {
    const auto alarms = due(now);
    if (alarms.empty()) return File{};
    frames_.ask();
    const auto* moments = frames_.asked();
    if (moments == nullptr) return File{};  // with the cycle's next frame
    auto written = write(*moments, alarms);
    frames_.give_back();
    waiting_.clear();
    last_written_ = now;
    has_written_ = true;
    return written;
}

Result<Evidence::File> Evidence::finish() {
    const auto alarms = due(Instant::max());
    if (alarms.empty()) return File{};
    waiting_.clear();
    return write(frames_.at_end(), alarms);
}

std::string Evidence::path_of(const Noticed& alarm) const {
    return (fs::path(config_.directory) /
            stamped_name(machine_.layout().machine, alarm.since.time_since_epoch() + epoch_, alarm.name, ending))
        .string();
}

Result<Evidence::File> Evidence::write(const Recorder& moments, const std::vector<Noticed>& alarms) {
    File file;
    file.alarms = alarms.size();
    std::optional<Instant> first;
    Instant last{};
    moments.for_each([&](const RecordView& record) {
        if (!first) first = record.time;
        last = record.time;
    });
    if (first) file.covered = last - *first;
    const auto path = path_of(alarms.front());
    const auto part = path + std::string{unfinished};
    std::string head = fmt::format("machine '{}': the last {:.1f} s of its bus before and {:.1f} s after the first alarm",
                                   machine_.layout().machine, first ? std::max(0.0, to_seconds(alarms.front().since - *first)) : 0.0,
                                   first ? std::max(0.0, to_seconds(last - alarms.front().since)) : 0.0);
    for (const auto& alarm : alarms)
        head += fmt::format("\n\n{} UTC ({:+.3f} s)  {}", utc_stamp(alarm.since.time_since_epoch() + epoch_),
                            to_seconds(alarm.since - alarms.front().since), alarm.text);
    auto created = ecat::PcapngFile::create(part, {machine_.layout().interface, head, epoch_});
    if (!created) return created.error();
    auto& out = **created;
    auto next = alarms.begin();
    Result<void> ok;
    moments.for_each([&](const RecordView& record) {
        if (!ok) return;
        std::string remark;
        for (; next != alarms.end() && next->since <= record.time; ++next) remark += (remark.empty() ? "ALARM " : "\nALARM ") + next->text;
        ok = out.packet(record.bytes, record.time, record.channel == ecat::sent_frames, remark);
    });
    if (ok) ok = out.finish();
    std::error_code failed;
    if (!ok) {
        created->reset();
        fs::remove(part, failed);
        return ok.error();
    }
    file.frames = out.packets();
    created->reset();
    fs::rename(part, path, failed);
    if (failed)
        return Error{"evidence.write", path, fmt::format("the file cannot get its name: {}", failed.message()),
                     "look into the folder: the frames may stand beside it in " + part};
    file.path = path;
    if (config_.files > 0) keep_newest(config_.directory, machine_.layout().machine, ending, config_.files, path);
    return file;
}

}  // namespace taktwerk::runtime
