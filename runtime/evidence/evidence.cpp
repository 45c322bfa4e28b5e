#include "runtime/evidence/evidence.hpp"

#include <algorithm>
#include <cctype>
#include <ctime>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "ecat/recording/pcapng_file.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::runtime {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view ending = ".pcapng", unfinished = ".part", utc_shape = "00000000T000000.000";

bool same(const AlarmFact& a, const AlarmFact& b) { return a.id == b.id && a.source == b.source && a.index == b.index; }

/// For names of files: letters, digits, underscores.
std::string plain(std::string_view text) {
    std::string out{text};
    for (char& c : out)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    return out;
}

/// 20261123T143015.123: sorts as it reads.
std::string utc(Duration since_1970) {
    const auto whole = std::chrono::floor<std::chrono::seconds>(since_1970);
    const std::time_t seconds = whole.count();
    std::tm parts{};
    ::gmtime_r(&seconds, &parts);
    return fmt::format("{:04}{:02}{:02}T{:02}{:02}{:02}.{:03}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday, parts.tm_hour,
                       parts.tm_min, parts.tm_sec, (since_1970 - whole) / std::chrono::milliseconds{1});
}

/// What stands between the machine's name and the alarm's in a name that path_of() made: 20261123T143015.123.
bool is_utc(std::string_view text) {
    if (text.size() != utc_shape.size()) return false;
    for (std::size_t i = 0; i < utc_shape.size(); ++i)
        if (utc_shape[i] == '0' ? std::isdigit(static_cast<unsigned char>(text[i])) == 0 : text[i] != utc_shape[i]) return false;
    return true;
}

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

void Evidence::notice(const AlarmFact& fact, Reaction reaction, Instant since) {
    if (reaction < Reaction::stop_axis) return;
    // Whoever pressed it knows why, and would push out what nobody knows.
    if (fact.id == id(MachineAlarm::emergency_stop) && fact.a != emergency_stop_unread) return;
    const auto known =
        std::find_if(standing_.begin(), standing_.end(), [&](const Noticed& n) { return same(n.fact, fact) && n.since == since; });
    if (known != standing_.end()) return;
    const auto words = machine_.describe(fact);
    standing_.push_back({fact, since, words.name, words_of(words)});
    const std::scoped_lock lock{mutex_};
    noticed_.push_back(standing_.back());
}

void Evidence::look(const Snapshot& snapshot) {
    if (snapshot.phase != MachinePhase::running) return;  // at the end the bus is meant to be silent
    const auto& passed = snapshot.passed_alarms;
    for (auto number = std::max(next_passed_, passed.oldest()); number < passed.noted(); ++number)
        notice(passed.at(number).fact, passed.at(number).reaction, passed.at(number).since);
    next_passed_ = passed.noted();
    const auto listed = [&](const Noticed& known) {
        return std::any_of(snapshot.alarms.begin(), snapshot.alarms.begin() + static_cast<std::ptrdiff_t>(snapshot.alarm_count),
                           [&](const ActiveAlarm& alarm) { return same(alarm.fact, known.fact) && alarm.since == known.since; });
    };
    std::erase_if(standing_, [&](const Noticed& known) { return !listed(known); });
    for (std::size_t i = 0; i < snapshot.alarm_count; ++i)
        notice(snapshot.alarms[i].fact, snapshot.alarms[i].reaction, snapshot.alarms[i].since);
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
    return (fs::path(config_.directory) / fmt::format("{}-{}-{}{}", plain(machine_.layout().machine),
                                                      utc(alarm.since.time_since_epoch() + epoch_), plain(alarm.name), ending))
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
        head += fmt::format("\n\n{} UTC ({:+.3f} s)  {}", utc(alarm.since.time_since_epoch() + epoch_),
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
    remove_oldest();
    return file;
}

void Evidence::remove_oldest() const {
    if (config_.files == 0) return;
    const auto mine = plain(machine_.layout().machine) + "-";
    std::vector<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(config_.directory, ignored)) {
        const auto name = entry.path().filename().string();
        if (name.starts_with(mine) && name.ends_with(ending) && is_utc(std::string_view{name}.substr(mine.size(), utc_shape.size())))
            names.push_back(entry.path().string());
    }
    std::sort(names.begin(), names.end());
    for (std::size_t i = 0; i + config_.files < names.size(); ++i) fs::remove(names[i], ignored);
}

}  // namespace taktwerk::runtime
