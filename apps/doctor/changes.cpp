#include "apps/doctor/changes.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "apps/doctor/host_files.hpp"
#include "core/replaced_file.hpp"

namespace taktwerk::apps {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* record_path = "/var/lib/taktwerk/doctor/applied.json";

Error not_written(const std::filesystem::path& path) {
    return {"doctor.not_written", path.string(), fmt::format("cannot be written: {}", std::strerror(errno)),
            "see who may write there, and whether there is room"};
}

Result<void> replace(const std::filesystem::path& path, const std::string& text) {
    errno = replace_file(path, text);
    return errno == 0 ? Result<void>{} : not_written(path);
}

/// A file of /proc or /sys takes a value whole or not at all.
Result<void> turn(const std::filesystem::path& path, const std::string& value) {
    const int file = ::open(path.c_str(), O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (file < 0) return not_written(path);
    const auto line = value + "\n";
    const auto put = ::write(file, line.data(), line.size());
    const auto done = put == static_cast<ssize_t>(line.size()) ? Result<void>{} : not_written(path);
    ::close(file);
    return done;
}

const char* word(HostChange::Kind kind) {
    return kind == HostChange::Kind::file ? "file" : kind == HostChange::Kind::knob ? "knob" : "ethernet";
}

std::string named(const HostChange& change) {
    return change.kind == HostChange::Kind::ethernet ? fmt::format("{} {}", change.target, name(change.knob)) : change.target;
}

bool same_place(const HostChange& a, const HostChange& b) { return a.kind == b.kind && a.target == b.target && a.knob == b.knob; }

/// For who wants it back by hand.
std::string was_before(const AppliedChange& applied) {
    if (!applied.before) return "before --apply it was not there";
    return applied.change.kind == HostChange::Kind::file ? fmt::format("what was there before --apply is in {}", record_path)
                                                         : fmt::format("before --apply it was {}", *applied.before);
}

/// A number of an interrupt means another device after a restart.
bool means_something_else(const AppliedChange& applied, const std::string& boot) {
    return applied.change.target.starts_with("/proc/irq/") && applied.boot != boot;
}

}  // namespace

std::string record_text(const std::vector<AppliedChange>& all) {
    auto list = Json::array();
    for (const auto& each : all) {
        Json one{{"kind", word(each.change.kind)}, {"target", each.change.target}};
        if (each.change.kind == HostChange::Kind::ethernet) one["knob"] = name(each.change.knob);
        one["before"] = each.before ? Json(*each.before) : Json(nullptr);
        one["after"] = each.change.value;
        one["made_folders"] = each.made_folders;
        one["boot"] = each.boot;
        list.push_back(std::move(one));
    }
    return list.dump(2) + "\n";
}

Result<std::vector<AppliedChange>> read_record(const std::string& text) {
    const Error wrong{"doctor.record", record_path, "is no record of changes of this version",
                      "look into it: it says what was there before; then remove it"};
    const auto list = Json::parse(text, nullptr, false);
    if (!list.is_array()) return wrong;
    std::vector<AppliedChange> all;
    for (const auto& one : list) {
        const auto string = [&one](const char* key) {
            return one.is_object() && one.contains(key) && one[key].is_string() ? std::optional{one[key].get<std::string>()} : std::nullopt;
        };
        const auto kind = string("kind"), target = string("target"), after = string("after");
        if (!kind || !target || target->empty() || !after || !one.contains("before")) return wrong;
        AppliedChange applied;
        applied.change.target = *target;
        applied.change.value = *after;
        if (*kind == "file") applied.change.kind = HostChange::Kind::file;
        else if (*kind == "knob") applied.change.kind = HostChange::Kind::knob;
        else if (const auto knob = ethernet_knob(string("knob").value_or("")); *kind == "ethernet" && knob) {
            applied.change.kind = HostChange::Kind::ethernet;
            applied.change.knob = *knob;
        } else return wrong;
        applied.before = string("before");
        if (!applied.before && !one["before"].is_null()) return wrong;
        if (one.contains("made_folders") && one["made_folders"].is_array())
            for (const auto& folder : one["made_folders"])
                if (folder.is_string()) applied.made_folders.push_back(folder.get<std::string>());
        applied.boot = string("boot").value_or("");
        all.push_back(std::move(applied));
    }
    return all;
}

std::string Changes::boot() const { return HostFiles(root_).text("/proc/sys/kernel/random/boot_id").value_or(""); }

Result<std::vector<AppliedChange>> Changes::recorded() const {
    const auto text = HostFiles(root_).text(record_path);
    if (!text) {
        if (HostFiles(root_).exists(record_path)) return Error{"doctor.record", record_path, "cannot be read", "only root may"};
        return std::vector<AppliedChange>{};
    }
    return read_record(*text);
}

Result<void> Changes::record(const std::vector<AppliedChange>& all) const {
    const auto path = below(record_path);
    std::error_code failed;
    std::filesystem::create_directories(path.parent_path(), failed);
    if (failed && !all.empty())
        return Error{"doctor.record", path.string(), "cannot be written: " + failed.message() + "; nothing was changed",
                     "see who may write there, and whether there is room"};
    if (all.empty()) {
        std::filesystem::remove(path, failed);
        std::filesystem::remove(path.parent_path(), failed);
        (void)sync_folder_of(path.parent_path());
        return {};
    }
    // That there is such a folder has to be on the disk as well, before anything is changed.
    for (const auto& folder : {path.parent_path(), path.parent_path().parent_path()}) (void)sync_folder_of(folder);
    auto written = replace(path, record_text(all));
    if (written) return {};
    auto error = written.error();
    error.code = "doctor.record";
    error.what += "; nothing was changed";
    return error;
}

std::optional<std::string> Changes::now(const HostChange& change) const {
    if (change.kind == HostChange::Kind::ethernet) {
        const auto value = value_of(ports_.read(change.target), change.knob);
        return value ? std::optional{std::to_string(*value)} : std::nullopt;
    }
    std::error_code failed;
    if (change.kind == HostChange::Kind::file) {
        if (!std::filesystem::exists(below(change.target), failed)) return std::nullopt;
        // Whole, with blanks at its end: it comes back as it was.
        std::string all;
        const int file = ::open(below(change.target).c_str(), O_RDONLY | O_CLOEXEC);
        char some[4096];
        for (ssize_t got = 0; file >= 0 && (got = ::read(file, some, sizeof some)) > 0;) all.append(some, static_cast<std::size_t>(got));
        if (file >= 0) ::close(file);
        return all;
    }
    auto text = HostFiles(root_).text(change.target);
    if (!text) return std::nullopt;
    const auto open = text->find('['), close = text->find(']');  // "always [madvise] never"
    return open != std::string::npos && close != std::string::npos && close > open ? text->substr(open + 1, close - open - 1) : *text;
}

Result<void> Changes::put(const HostChange& change, const std::string& value) const {
    if (change.kind == HostChange::Kind::ethernet)
        return ports_.set(change.target, change.knob, static_cast<std::uint32_t>(std::strtoul(value.c_str(), nullptr, 10)));
    if (change.kind == HostChange::Kind::knob) return turn(below(change.target), value);
    std::error_code failed;
    std::filesystem::create_directories(below(change.target).parent_path(), failed);
    return replace(below(change.target), value);
}

std::vector<std::string> Changes::missing_folders(const std::string& path) const {
    std::vector<std::string> all;
    std::error_code ignored;
    for (auto folder = std::filesystem::path(path).parent_path();
         folder != "/" && !std::filesystem::exists(below(folder.string()), ignored); folder = folder.parent_path())
        all.push_back(folder.string());
    return all;
}

Result<std::vector<ChangeOutcome>> Changes::apply(const std::vector<HostChange>& wanted) {
    auto known = recorded();
    if (!known) return known.error();
    auto all = std::move(known).value();
    std::vector<ChangeOutcome> done;
    for (const auto& change : wanted) {
        const auto before = now(change);
        if (before == change.value) continue;
        // There is nothing to turn: another kernel, another driver.
        if (!before && change.kind != HostChange::Kind::file) continue;
        const auto old = std::find_if(all.begin(), all.end(), [&](const auto& each) { return same_place(each.change, change); });
        auto next = all;
        if (old != all.end()) {
            auto& known_one = next[static_cast<std::size_t>(old - all.begin())];
            if (before != old->change.value) known_one.before = before;  // somebody else has changed it since: that is what comes back
            known_one.change.value = change.value;
        } else
            next.push_back({change, before,
                            change.kind == HostChange::Kind::file ? missing_folders(change.target) : std::vector<std::string>{}, boot()});
        if (auto written = record(next); !written) return written.error();
        ChangeOutcome outcome{change.kind == HostChange::Kind::file
                                  ? fmt::format("{}: {}", change.target, before ? "written anew" : "new file")
                                  : fmt::format("{}: {} -> {}", named(change), *before, change.value)};
        if (auto changed = put(change, change.value); !changed) outcome.error = changed.error();
        else if (const auto after = now(change); after != change.value)
            outcome.error = Error{"doctor.not_taken", named(change),
                                  fmt::format("{} was written, and it says {}", change.value, after.value_or("nothing")),
                                  "the driver has values of its own; `--revert` puts back what was there"};
        const auto after = now(change);
        if (outcome.error && after == before) {
            if (auto written = record(all); !written) return written.error();  // nothing to take back
        } else {
            if (outcome.error && after) {  // what is there now is ours, whatever was asked for
                const auto ours = std::find_if(next.begin(), next.end(), [&](const auto& each) { return same_place(each.change, change); });
                ours->change.value = *after;
                if (auto written = record(next); !written) return written.error();
            }
            all = std::move(next);
        }
        done.push_back(std::move(outcome));
    }
    return done;
}

Result<std::vector<ChangeOutcome>> Changes::apply_together(const std::vector<HostChange>& wanted) {
    std::vector<HostChange> for_next_start, for_now;
    for (const auto& change : wanted) (change.kind == HostChange::Kind::file ? for_next_start : for_now).push_back(change);
    auto done = apply(for_next_start);
    if (!done || std::any_of(done->begin(), done->end(), [](const auto& outcome) { return outcome.error.has_value(); })) return done;
    auto more = apply(for_now);
    if (!more) return more;
    done->insert(done->end(), std::make_move_iterator(more->begin()), std::make_move_iterator(more->end()));
    return done;
}

Result<void> Changes::take_back(const AppliedChange& applied) const {
    if (applied.before) return put(applied.change, *applied.before);
    std::error_code failed;
    std::filesystem::remove(below(applied.change.target), failed);
    if (failed) {
        errno = failed.value();
        return not_written(applied.change.target);
    }
    // Before the record of it goes.
    (void)sync_folder_of(below(applied.change.target));
    for (const auto& folder : applied.made_folders) std::filesystem::remove(below(folder), failed);  // one that others use by now stays
    return {};
}

Result<std::vector<ChangeOutcome>> Changes::revert() {
    auto known = recorded();
    if (!known) return known.error();
    auto all = std::move(known).value();
    std::vector<ChangeOutcome> done;
    std::vector<AppliedChange> kept;
    while (!all.empty()) {
        const auto applied = all.back();
        const auto current = now(applied.change);
        ChangeOutcome outcome{fmt::format("{}: ", named(applied.change))};
        if (current == applied.before || means_something_else(applied, boot())) {
            outcome.words += "is as it was already";
        } else if (!current && applied.change.kind != HostChange::Kind::file) {
            outcome.words += "is not there any more";
        } else if (current != applied.change.value) {
            outcome.words += "left alone: somebody else has changed it since; " + was_before(applied);
            outcome.left = true;
            kept.insert(kept.begin(), applied);
        } else if (auto back = take_back(applied); !back) {
            outcome.words += "not taken back";
            outcome.error = back.error();
            kept.insert(kept.begin(), applied);
        } else {
            outcome.words += applied.change.kind == HostChange::Kind::file ? applied.before ? "has its old text" : "removed"
                                                                           : fmt::format("{} -> {}", applied.change.value, *applied.before);
        }
        all.pop_back();
        auto rest = all;
        rest.insert(rest.end(), kept.begin(), kept.end());
        if (auto written = record(rest); !written) return written.error();
        done.push_back(std::move(outcome));
    }
    return done;
}

}  // namespace taktwerk::apps
