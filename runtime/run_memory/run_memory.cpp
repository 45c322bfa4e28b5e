#include "runtime/run_memory/run_memory.hpp"

#include <algorithm>
#include <filesystem>
#include <span>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "runtime/alarms.hpp"
#include "runtime/stamped_name.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view unfinished = ".part";
constexpr std::size_t most_wishes = 16;  ///< waiting at once; what comes then is in the last one's file all the same

}  // namespace

Result<std::unique_ptr<RunMemory>> RunMemory::open(RecordingInfo info, Place place, Room room) {
    std::error_code failed;
    fs::create_directories(place.folder, failed);
    if (failed && !fs::is_directory(place.folder))
        return Error{"recording.directory", place.folder, fmt::format("the folder for recordings cannot be made: {}", failed.message()),
                     "choose another one: `recording: {directory: ...}`, or --recordings"};
    std::unique_ptr<RunMemory> memory{new RunMemory{std::move(info), std::move(place), room}};
    memory->clean();
    for (const auto& path : entries_of(memory->place_.folder))
        if (path.extension() == replay_ending) memory->there_.insert(path.string());
    return memory;
}

void RunMemory::clean() const {
    std::error_code ignored;
    for (const auto& path : entries_of(place_.folder))
        if (is_stamped(path.filename().string(), place_.machine, std::string{replay_ending} + std::string{unfinished}))
            fs::remove(path, ignored);
}

std::string RunMemory::path_for(std::string_view why, Instant at) const {
    const auto since_1970 = at.time_since_epoch() + place_.epoch;
    const auto path = [&](const std::string& word) {
        return (fs::path(place_.folder) / stamped_name(place_.machine, since_1970, word, replay_ending)).string();
    };
    auto wished = path(std::string{why});
    for (int i = 2; there_.contains(wished); ++i) wished = path(fmt::format("{}_{}", why, i));
    return wished;
}

// --- service side -------------------------------------------------------------------------------------------------------------------

void RunMemory::look(const Snapshot& snapshot, const NameOf& name_of) {
    // At the end things are meant to stop: then only what came before it.
    auto until = Instant::max();
    if (snapshot.phase != MachinePhase::running) {
        const auto listed = std::span{snapshot.alarms}.first(snapshot.alarm_count);
        const auto end = std::ranges::find(listed, id(MachineAlarm::stopped_by_signal), [](const ActiveAlarm& a) { return a.fact.id; });
        if (end == listed.end()) return;
        until = end->since;
    }
    alarms_.look(snapshot, [&](const AlarmFact& fact, Reaction reaction, Instant since) {
        if (reaction < Reaction::stop_axis || since >= until) return false;
        const auto name = name_of(fact);
        const std::scoped_lock lock{mutex_};
        wish({name, since, since + place_.after});
        if (path_.empty()) path_ = path_for(name, since);
        return true;
    });
}

Result<std::string> RunMemory::keep(Instant now) {
    const std::scoped_lock lock{mutex_};
    const bool part = sound_part();
    if (!ended_ || part) {
        wish({"", now, now});
        if (path_.empty()) path_ = path_for("asked", now);
    }
    if (!ended_) return path_;
    return Error{"recording.ended", place_.machine, fmt::format("this run is taken no further: {}", ended_->what),
                 part ? fmt::format("What came before can be replayed: {}. {}", path_, ended_->remedy) : ended_->remedy};
}

void RunMemory::wish(Wish more) {
    const auto behind = std::ranges::upper_bound(wishes_, more.until, {}, &Wish::until);
    wishes_.insert(behind, std::move(more));
    // The last one has what the one before it wants.
    if (wishes_.size() > most_wishes) wishes_.erase(wishes_.end() - 2);
}

RunMemory::State RunMemory::state() const {
    const std::scoped_lock lock{mutex_};
    const bool waits = !wishes_.empty() || writing_;
    const bool asked = writing_ || std::ranges::any_of(wishes_, [](const Wish& wish) { return wish.why.empty(); });
    return {std::max(until_, place_.start) - place_.start, blocks_.bytes(), on_disk_, kept_ || waits ? path_ : "", waits, asked, ended_};
}

// --- a thread that may wait ------------------------------------------------------------------------------------------------------------

void RunMemory::take(const PackedBlock& block, Instant until, std::uint64_t lost) {
    const std::scoped_lock lock{mutex_};
    if (lost > 0 && !ended_) {
        // Blocks that were taken when nothing was lost are whole; this one may have a gap.
        ended_ = Error{"recording.lost", place_.machine,
                       fmt::format("{} records of the run did not get here: from there on nothing is certain", lost),
                       "This computer has no time for it: look at its load, or write `recording: {replay: false}`"};
    }
    if (ended_) return;
    until_ = until;
    blocks_.push(block);
}

Error RunMemory::end(Error why) {
    const std::scoped_lock lock{mutex_};
    // By the name that it has by now.
    if (kept_ && why.subject.ends_with(unfinished)) why.subject.resize(why.subject.size() - unfinished.size());
    blocks_.clear();
    ended_ = why;
    return why;
}

Result<void> RunMemory::write_blocks(const std::string& path, bool wished) {
    if (!file_) {
        auto created = RecordingWriter::create(path + std::string{unfinished}, info_, {0, room_.disk});
        if (!created) return std::move(created).error();
        file_ = std::move(*created);
    }
    for (;;) {
        PackedBlock block;
        {
            const std::scoped_lock lock{mutex_};
            if (blocks_.empty()) return {};
            block = blocks_.pop();
        }
        auto done = file_->write(block);
        {
            const std::scoped_lock lock{mutex_};
            on_disk_ = file_->bytes();
        }
        if (done) continue;
        auto error = done.error();
        if (error.code == "recording.limit") {
            error = {"recording.limit", place_.machine,
                     fmt::format("the run is longer than the {} bytes that its replay may have on the disk", room_.disk),
                     std::string(wished ? "What came before can be replayed. " : "Nothing of this run is kept. ") +
                         "For longer runs: `recording: {replay_disk: ...}`; each start begins anew"};
            (void)file_->finish(RecordingEnd::limit, 0).ok();
        }
        return error;
    }
}

void RunMemory::keep_bounds() const {
    const auto newest = path_;
    keep_newest(place_.folder, place_.machine, replay_ending, room_.files, newest);
    std::vector<std::pair<std::string, std::uint64_t>> files;
    std::error_code ignored;
    std::uint64_t all = file_ ? file_->bytes() : 0;
    for (const auto& path : entries_of(place_.folder)) {
        if (!is_stamped(path.filename().string(), place_.machine, replay_ending) || path == newest) continue;
        const auto bytes = fs::file_size(path, ignored);
        if (ignored) continue;
        files.emplace_back(path.string(), bytes);
        all += bytes;
    }
    std::ranges::sort(files);
    for (const auto& [path, bytes] : files) {
        if (all <= room_.disk) return;
        if (fs::remove(path, ignored)) all -= bytes;
    }
}

Result<void> RunMemory::give_name(const std::string& path) {
    if (kept_) return {};
    std::error_code failed;
    fs::rename(path + std::string{unfinished}, path, failed);
    if (failed)
        return Error{"recording.write", path, fmt::format("the recording cannot get its name: {}", failed.message()),
                     "look into that folder"};
    const std::scoped_lock lock{mutex_};
    kept_ = true;
    return {};
}

Result<RunMemory::Kept> RunMemory::write(const Wish& wish) {
    const auto path = [&] {
        const std::scoped_lock lock{mutex_};
        return path_;
    }();
    if (auto done = write_blocks(path, true); !done) {
        // What the room had space for is whole and can be replayed.
        if (done.error().code == "recording.limit") (void)give_name(path).ok();
        return end(done.error());
    }
    if (auto done = file_->finish(RecordingEnd::kept, 0); !done) return end(done.error());
    if (auto done = give_name(path); !done) return end(done.error());
    keep_bounds();
    return Kept{path, wish.why, std::max(until_, place_.start) - place_.start, file_->bytes()};
}

Result<RunMemory::Kept> RunMemory::work() {
    std::optional<Wish> due;
    bool full = false;
    std::string path;
    {
        const std::scoped_lock lock{mutex_};
        if (ended_ && !said_) {
            said_ = true;
            return *ended_;
        }
        if (!wishes_.empty() && (ended_ || wishes_.front().until <= until_)) {
            due = wishes_.front();
            wishes_.pop_front();
            // One file has them all.
            while (!wishes_.empty() && !ended_ && wishes_.front().until <= until_) wishes_.pop_front();
        }
        if (due && ended_ && !sound_part()) return too_late(*due);
        writing_ = due.has_value();
        full = blocks_.bytes() > room_.memory;
        if (full && path_.empty()) path_ = path_for("run", place_.start);
        path = path_;
    }
    if (due) {
        auto kept = write(*due);
        said_ = said_ || !kept;
        const std::scoped_lock lock{mutex_};
        writing_ = false;
        if (kept && ended_ && due->at > until_) return too_late(*due);
        return kept;
    }
    if (!full || ended_) return Kept{};
    auto done = write_blocks(path, kept_);
    if (done && kept_) done = file_->finish(RecordingEnd::kept, 0);
    if (!done) {
        said_ = true;
        if (!kept_) discard();
        return end(done.error());
    }
    if (kept_) keep_bounds();  // what nobody asked for takes no room of what somebody did
    return Kept{};
}

Error RunMemory::too_late(const Wish& wish) const {
    return {"recording.ended", wish.why.empty() ? place_.machine : wish.why,
            fmt::format("what led to it cannot be replayed: {}", ended_->what),
            kept_ ? fmt::format("What came before can be: {}. {}", path_, ended_->remedy) : ended_->remedy};
}

void RunMemory::discard() {
    if (!file_) return;
    file_.reset();
    clean();
}

Result<RunMemory::Kept> RunMemory::finish() {
    std::optional<Wish> last;
    {
        const std::scoped_lock lock{mutex_};
        if (!wishes_.empty() && !ended_) last = wishes_.back();
        wishes_.clear();
    }
    if (last) {
        auto kept = write(*last);
        if (!kept_) discard();
        return kept;
    }
    if (!kept_) discard();
    return Kept{};
}

}  // namespace taktwerk::runtime
