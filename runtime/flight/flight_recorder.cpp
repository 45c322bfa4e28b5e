#include "runtime/flight/flight_recorder.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <set>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "runtime/alarms.hpp"
#include "runtime/recording/cycle_at.hpp"
#include "runtime/stamped_name.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view unfinished = ".part";
constexpr std::size_t alarms_remembered = 256, rows_at_once = 256;

std::uint64_t cycles_in(Duration time, Duration cycle) { return static_cast<std::uint64_t>(time / cycle); }

}  // namespace

FlightRecorder::FlightRecorder(const Machine& machine, std::string folder, Duration epoch)
    : machine_(machine), config_(machine.config().recording), folder_(std::move(folder)), epoch_(epoch) {}

Result<std::unique_ptr<FlightRecorder>> FlightRecorder::open(const Machine& machine, std::string folder, Duration epoch) {
    std::error_code failed;
    fs::create_directories(folder, failed);
    if (failed && !fs::is_directory(folder))
        return Error{"recording.directory", folder, fmt::format("the folder for recordings cannot be made: {}", failed.message()),
                     "choose another one: `recording: {directory: ...}`, or --recordings"};
    auto recorder = std::unique_ptr<FlightRecorder>{new FlightRecorder{machine, std::move(folder), epoch}};
    recorder->find_kept();
    return recorder;
}

void FlightRecorder::find_kept() {
    const auto& machine = machine_.layout().machine;
    std::vector<fs::path> files;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
        const auto name = entry.path().filename().string();
        if (is_stamped(name, machine, std::string{scope_ending} + std::string{unfinished})) fs::remove(entry.path(), ignored);
        else if (is_stamped(name, machine, scope_ending)) files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        const auto info = look_at_scope_file(file.string());
        if (!info) continue;  // whoever asks for it by name is told why
        const auto& head = info->head;
        const auto alarm = head.alarms.empty() ? ScopeHead::Alarm{} : head.alarms.front();
        kept_.push_back({file.stem().string(), alarm.name, alarm.source, head.utime, head.first_cycle, head.first_cycle + info->rows,
                         alarm.cycle, info->bytes, !head.cut});
    }
}

std::string FlightRecorder::name_for(Instant since, std::string_view alarm) const {
    const auto wished = stamped_name(machine_.layout().machine, since.time_since_epoch() + epoch_, alarm, "");
    const auto taken = [&](const std::string& name) {
        return std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& w) { return w.kept.name == name; }) ||
               std::any_of(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.name == name; });
    };
    auto name = wished;
    for (int i = 2; taken(name); ++i) name = fmt::format("{}-{}", wished, i);
    return name;
}

bool FlightRecorder::notice(const AlarmFact& fact, Reaction reaction, Instant since) {
    if (reaction < Reaction::stop_axis) return false;
    const auto& ring = machine_.signals();
    const auto words = machine_.describe(fact);
    const auto cycle = cycle_at(ring, since);
    const auto before = cycles_in(config_.before, ring.cycle()), after = cycles_in(config_.after, ring.cycle());
    const ScopeHead::Alarm alarm{fact.id, words.name, words.source, words.english, words.chinese, cycle};

    const std::scoped_lock lock{mutex_};
    const bool joins = !waiting_.empty() && !waiting_.back().being_written &&
                       (waiting_.size() >= most_waiting || cycle <= waiting_.back().kept.alarm_cycle + cycles_in(together, ring.cycle()));
    if (!joins) {
        const auto first = std::max(ring.span().first, cycle > before ? cycle - before : 1);
        const auto utime = std::chrono::duration_cast<std::chrono::microseconds>(since.time_since_epoch() + epoch_).count();
        waiting_.push_back(
            {{name_for(since, words.name), words.name, words.source, utime, std::min(first, cycle), cycle + after, cycle, 0, false},
             {},
             false});
    }
    auto& waiting = waiting_.back();
    waiting.kept.to = std::max(waiting.kept.to, cycle + after);
    waiting.alarms.push_back(alarm);
    by_alarm_.push_back({{fact, since}, waiting.kept.name});
    if (by_alarm_.size() > alarms_remembered) by_alarm_.pop_front();
    return true;
}

void FlightRecorder::look(const Snapshot& snapshot) {
    if (config_.files == 0) return;
    // At the end things are meant to stop: then only what came before it.
    auto until = Instant::max();
    if (snapshot.phase != MachinePhase::running) {
        const auto listed = std::span{snapshot.alarms}.first(snapshot.alarm_count);
        const auto end = std::ranges::find(listed, id(MachineAlarm::stopped_by_signal), [](const ActiveAlarm& a) { return a.fact.id; });
        if (end == listed.end()) return;
        until = end->since;
    }
    alarms_.look(snapshot,
                 [&](const AlarmFact& fact, Reaction reaction, Instant since) { return since < until && notice(fact, reaction, since); });
}

std::string FlightRecorder::recording_of(const AlarmFact& fact, Instant since) const {
    const std::scoped_lock lock{mutex_};
    for (const auto& [shown, name] : by_alarm_)
        if (shown.fact.id == fact.id && shown.fact.source == fact.source && shown.fact.index == fact.index && shown.since == since)
            return name;
    return {};
}

std::vector<FlightRecorder::Kept> FlightRecorder::kept() const {
    const std::scoped_lock lock{mutex_};
    auto all = kept_;
    for (const auto& waiting : waiting_) all.push_back(waiting.kept);
    std::reverse(all.begin(), all.end());
    return all;
}

std::optional<Error> FlightRecorder::why_not(const std::string& name) const {
    if (std::any_of(waiting_.begin(), waiting_.end(), [&](const Waiting& w) { return w.kept.name == name; }))
        return Error{"recording.not_yet", name, "its last seconds are still being recorded", "Ask again in some seconds."};
    // Only what is known is opened: a name is no path.
    if (std::none_of(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.name == name; }))
        return Error{"recording.unknown", name, "there is no recording of this name (any more)", "`recordings` lists those that are kept."};
    return std::nullopt;
}

std::optional<Result<FlightRecorder::Part>> FlightRecorder::part(const std::string& name, std::uint64_t from) {
    const std::scoped_lock lock{mutex_};
    if (const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const AskedPart& p) { return p.name == name && p.from == from; });
        found != parts_.end()) {
        if (!found->part) return std::nullopt;
        auto part = *std::move(found->part);
        parts_.erase(found);
        return part;
    }
    if (auto error = why_not(name)) return *std::move(error);
    parts_.push_front({name, from, std::nullopt});
    while (parts_.size() > most_parts) parts_.pop_back();
    return std::nullopt;
}

void FlightRecorder::read_next_part() {
    std::string name;
    std::uint64_t from = 0;
    {
        const std::scoped_lock lock{mutex_};
        const auto asked = std::find_if(parts_.rbegin(), parts_.rend(), [](const AskedPart& p) { return !p.part; });  // the oldest
        if (asked == parts_.rend()) return;
        name = asked->name;
        from = asked->from;
    }
    const auto path = fs::path(folder_) / (name + std::string{scope_ending});
    std::error_code failed;
    Part part{fs::file_size(path, failed), {}};
    std::ifstream file{path, std::ios::binary};
    if (!failed && file && from < part.size) {
        part.bytes.resize(std::min<std::uint64_t>(part_bytes, part.size - from));
        file.seekg(static_cast<std::streamoff>(from));
        file.read(part.bytes.data(), static_cast<std::streamsize>(part.bytes.size()));
    }
    auto read = failed || !file
                    ? Result<Part>{Error{"recording.read", name, "its file cannot be read", "Look into that folder and at that disk."}}
                    : Result<Part>{std::move(part)};
    const std::scoped_lock lock{mutex_};
    for (auto& one : parts_)
        if (one.name == name && one.from == from && !one.part) one.part = std::move(read);
}

std::optional<Result<FlightRecorder::Rows>> FlightRecorder::rows(const std::string& name) {
    const std::scoped_lock lock{mutex_};
    if (const auto found = std::find_if(loaded_.begin(), loaded_.end(), [&](const Loaded& l) { return l.name == name; });
        found != loaded_.end()) {
        if (!found->rows) return std::nullopt;
        auto rows = *found->rows;
        if (!rows) loaded_.erase(found);  // another time it may be readable
        return rows;
    }
    if (auto error = why_not(name)) return *std::move(error);
    loaded_.push_front({name, std::nullopt});
    while (loaded_.size() > most_loaded) loaded_.pop_back();
    return std::nullopt;
}

void FlightRecorder::load_next() {
    std::string name;
    {
        const std::scoped_lock lock{mutex_};
        const auto asked = std::find_if(loaded_.begin(), loaded_.end(), [](const Loaded& l) { return !l.rows; });
        if (asked == loaded_.end()) return;
        name = asked->name;
    }
    auto read = read_scope_file((fs::path(folder_) / (name + std::string{scope_ending})).string());
    auto rows = read ? Result<Rows>{std::make_shared<const KeptRows>(std::move(*read))} : Result<Rows>{read.error()};
    const std::scoped_lock lock{mutex_};
    for (auto& loaded : loaded_)
        if (loaded.name == name && !loaded.rows) loaded.rows = std::move(rows);
}

Result<FlightRecorder::File> FlightRecorder::write(Waiting& waiting) const {
    const auto& ring = machine_.signals();
    auto& kept = waiting.kept;
    const auto there = ring.span();
    const auto wanted_from = kept.from, wanted_to = kept.to;
    kept.to = std::min(kept.to, there.last + 1);
    kept.from = std::max(kept.from, there.first);
    if (kept.from >= kept.to)
        return Error{"recording.too_late", kept.name, "its cycles were overwritten before the disk took them",
                     "look at that disk, or let the memory be deeper: `recording: {depth: ...}`"};
    std::vector<std::uint16_t> words(ring.words());
    std::iota(words.begin(), words.end(), std::uint16_t{0});
    std::vector<std::uint64_t> block(ring.words() * rows_at_once);
    // The oldest rows are the first to be overwritten, and the head says where it begins.
    auto count = std::min<std::uint64_t>(rows_at_once, kept.to - kept.from);
    if (const auto right = ring.read(kept.from, kept.from + count, words, block); right != kept.from) {
        kept.from = std::min(ring.span().first + rows_at_once, kept.to - 1);
        count = std::min<std::uint64_t>(rows_at_once, kept.to - kept.from);
    }
    kept.complete = kept.to == wanted_to && kept.from == wanted_from;
    const auto path = (fs::path(folder_) / (kept.name + std::string{scope_ending})).string(), part = path + std::string{unfinished};
    ScopeHead head{
        machine_.layout().machine, ring.cycle(), ring.words(), ring.signals(), kept.from, kept.utime, !kept.complete, waiting.alarms};
    std::error_code failed;
    const auto give_up = [&](Error error) {
        fs::remove(part, failed);
        return error;
    };
    auto file = ScopeFileWriter::create(part, head);
    if (!file) return give_up(file.error());
    for (auto at = kept.from; at < kept.to; at += count) {
        count = std::min<std::uint64_t>(rows_at_once, kept.to - at);
        const auto columns = std::span{block}.first(count * ring.words());
        if (ring.read(at, at + count, words, columns) != at)
            return give_up({"recording.too_late", kept.name, "its cycles were overwritten while the disk took them",
                            "look at that disk, or let the memory be deeper: `recording: {depth: ...}`"});
        if (auto ok = file->write(columns); !ok) return give_up(ok.error());
    }
    if (auto ok = file->finish(); !ok) return give_up(ok.error());
    kept.bytes = file->bytes();
    fs::rename(part, path, failed);
    if (failed)
        return give_up(
            {"recording.write", path, fmt::format("the recording cannot get its name: {}", failed.message()), "look into that folder"});
    return File{path, static_cast<std::int64_t>(kept.to - kept.from) * ring.cycle(), waiting.alarms, kept.bytes};
}

Result<FlightRecorder::File> FlightRecorder::write_next(bool all) {
    Waiting next;
    {
        const std::scoped_lock lock{mutex_};
        if (waiting_.empty() || (!all && machine_.signals().span().last + 1 < waiting_.front().kept.to)) return File{};
        waiting_.front().being_written = true;
        next = waiting_.front();
    }
    auto written = write(next);
    std::set<std::string> there;
    std::error_code ignored;
    if (written) keep_newest(folder_, machine_.layout().machine, scope_ending, config_.files, written->path);
    for (const auto& entry : fs::directory_iterator(folder_, ignored)) there.insert(entry.path().filename().string());
    const std::scoped_lock lock{mutex_};
    waiting_.pop_front();
    if (written) kept_.push_back(next.kept);
    else std::erase_if(by_alarm_, [&](const auto& entry) { return entry.second == next.kept.name; });
    if (!ignored) std::erase_if(kept_, [&](const Kept& k) { return there.count(k.name + std::string{scope_ending}) == 0; });
    return written;
}

Result<FlightRecorder::File> FlightRecorder::work() {
    load_next();
    read_next_part();
    return write_next(false);
}

Result<FlightRecorder::File> FlightRecorder::finish() { return write_next(true); }

}  // namespace taktwerk::runtime
