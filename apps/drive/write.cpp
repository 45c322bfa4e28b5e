// Writing parameters with care for the EEPROM, and telling what was written.

#include <algorithm>

#include <fmt/format.h>

#include "apps/drive/drive.hpp"
#include "apps/terminal/count_text.hpp"
#include "apps/terminal/exit_code.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using namespace std::chrono_literals;
using axes::DriveParameter;
using axes::ParameterStorage;

constexpr Duration between_stored_writes = 100ms;  // an EEPROM cell needs up to 10 ms; the drive does other things, too

constexpr const char* lost_at_power_off = "The values are lost at power off; --store keeps them.";

const DriveParameter* parameter_at(const axes::DriveProfile& profile, const axes::ParameterAddress& address) {
    for (const auto& parameter : profile.parameters)
        if (parameter.address == address) return &parameter;
    return nullptr;
}

/// The writing itself; stops at the first failure, and then puts back what it has switched for its own sake.
class Writer {
public:
    Writer(DriveAccess& drive, Storing storing) : drive_(drive), profile_(drive.profile()), storing_(storing) {}

    Written run(const std::vector<config::ParameterSet::Value>& values) {
        find_wanted(values);
        const bool nothing = wanted_.empty() && storing_ == Storing::volatile_only;
        if (nothing || values.empty() || !may_store() || !may_count()) return std::move(out_);
        if (settings() > 0) prepare();
        for (const auto& change : wanted_) {
            if (out_.error) break;
            write(change);
        }
        put_back();
        finish();
        return std::move(out_);
    }

private:
    [[nodiscard]] bool stores_each() const noexcept {
        return storing_ == Storing::asked && profile_.storage.way == ParameterStorage::each_write;
    }

    /// Does something when it is written; what it reads afterwards is its state or nothing (CiA 301 1011h: what can be restored).
    [[nodiscard]] static bool is_act(const DriveParameter& parameter) noexcept { return parameter.action; }

    [[nodiscard]] std::size_t settings() const {
        return static_cast<std::size_t>(
            std::count_if(wanted_.begin(), wanted_.end(), [](const Change& change) { return !is_act(*change.parameter); }));
    }

    void find_wanted(const std::vector<config::ParameterSet::Value>& values) {
        for (const auto& value : values) {
            if (is_act(*value.parameter)) {
                wanted_.push_back({value.parameter, std::nullopt, value.raw});  // what it reads says nothing about what it does
                continue;
            }
            const auto now = drive_.read(*value.parameter);
            // What is in force may never have been stored: a drive that stores by writing gets it again. What cannot be read is
            // written unseen (SE-808X 6098h).
            if (now && *now == value.raw && !stores_each()) continue;
            wanted_.push_back({value.parameter, now ? std::optional{*now} : std::nullopt, value.raw});
        }
        // A set holds the storage switch among the others: written in its place it would decide what becomes of those behind it.
        std::stable_partition(wanted_.begin(), wanted_.end(),
                              [&](const Change& change) { return change.parameter->address != profile_.storage.switched_by; });
    }

    bool may_store() {
        if (storing_ != Storing::asked) return true;
        if (profile_.storage.way == ParameterStorage::never)
            out_.error = Error{"drive.cannot_store", drive_.subject(), "has no way to store parameters over the bus",
                               "leave --store away, and store with the maker's own tool"};
        else if (profile_.storage.way == ParameterStorage::not_stated)
            out_.error =
                Error{"drive.cannot_store", drive_.subject(), "its manual does not say how it stores parameters", "leave --store away"};
        return !out_.error;
    }

    /// What counts after a restart, and is lost by then, would never count: better not written, because it would read as if it did.
    bool may_count() {
        if (storing_ == Storing::asked || profile_.storage.way == ParameterStorage::not_stated) return true;
        std::string names;
        const DriveParameter* first = nullptr;
        for (const auto& change : wanted_) {
            if (!change.parameter->waits_for_restart() || change.from == change.to) continue;
            names += (first ? ", " : "") + axes::name_of(*change.parameter);
            if (!first) first = change.parameter;
        }
        if (!first) return true;
        const bool never = profile_.storage.way == ParameterStorage::never;
        out_.error =
            Error{never ? "drive.cannot_store" : "drive.needs_store", drive_.subject(),
                  fmt::format("{}: the drive looks at it when it is switched on only, and what is not stored is lost by then. Nothing was "
                              "written",
                              names),
                  never ? "set it with the maker's tool or the panel, save it there, and switch the drive off and on"
                        : "add --store, and switch the drive off and on afterwards"};
        return false;
    }

    /// A drive that stores each write is told not to, or to do it, as asked.
    void prepare() {
        if (profile_.storage.way != ParameterStorage::each_write) return;
        const auto* sw = profile_.storage.switched_by.index ? parameter_at(profile_, profile_.storage.switched_by) : nullptr;
        if (!sw) {
            out_.notes.push_back(
                fmt::format("{} stores every write in its EEPROM: {} more of some 100,000.", profile_.name, wanted_.size()));
            return;
        }
        const auto now = drive_.read(*sw);
        if (!now) {
            out_.error = now.error();
            return;
        }
        const auto set = [&](std::int64_t value, const std::string& note) {
            if (auto done = drive_.write(*sw, value, storing_); !done) out_.error = done.error();
            else out_.notes.push_back(note);
        };
        if (storing_ == Storing::volatile_only && *now != 0)
            set(0, fmt::format(
                       "{} was {}: now 0, so that these writes do not wear the EEPROM. They are lost at power off; --store keeps them.",
                       axes::name_of(*sw), *now));
        else if (storing_ == Storing::volatile_only) out_.notes.emplace_back(lost_at_power_off);
        // Values between store a part only (SV33-E P05.10 = 1: the 2000h, 2: the 6000h).
        if (storing_ == Storing::asked && *now != sw->value) {
            // Who writes the switch itself decides how it stays.
            const bool meant = std::any_of(wanted_.begin(), wanted_.end(), [&](const Change& change) { return change.parameter == sw; });
            if (!meant) switched_ = sw, switched_from_ = *now;  // before the write: a drive may have taken what it did not answer
            set(sw->value, fmt::format("{} was {}: {} while these values are stored{}", axes::name_of(*sw), *now, sw->value,
                                       meant ? std::string(".") : fmt::format(", then {} again.", *now)));
        }
    }

    void write(const Change& change) {
        if (auto done = drive_.write(*change.parameter, change.to, storing_); !done) {
            out_.error = done.error();
            return;
        }
        if (is_act(*change.parameter)) {
            ++out_.acts;
            out_.notes.push_back(fmt::format("{} ({}): {} written, and the drive took it", axes::name_of(*change.parameter),
                                             change.parameter->name, axes::value_text(*change.parameter, change.to)));
            return;
        }
        if (change.from != change.to) out_.changes.push_back(change);
        const auto back = drive_.read(*change.parameter);
        if (back && *back != change.to) {
            out_.error = Error{"drive.not_taken", fmt::format("{} {}", drive_.subject(), axes::name_of(*change.parameter)),
                               fmt::format("{} was written, but it reads {}", axes::value_text(*change.parameter, change.to),
                                           axes::value_text(*change.parameter, *back)),
                               "see in the manual when the drive takes this value"};
            return;
        }
        ++written_;
        if (change.parameter->waits_for_restart() && change.from != change.to) late_.push_back(axes::name_of(*change.parameter));
        if (stores_each()) drive_.wait(between_stored_writes);
    }

    /// Whatever happened, Ctrl-C too: a switch that stays on wears the EEPROM with every write of everybody.
    void put_back() {
        if (!switched_) return;
        drive_.finish_undisturbed();
        const auto done = drive_.write(*switched_, switched_from_, Storing::volatile_only);
        if (done) return;
        const auto name = axes::name_of(*switched_);
        out_.notes.push_back(
            fmt::format("{} may still be {}: it could not be set back to {} ({}). Until it is, every write wears the EEPROM: "
                        "taktwerk drive set {} {}={}",
                        name, switched_->value, switched_from_, done.error().what, drive_.word(), name, switched_from_));
        if (!out_.error) out_.error = done.error();
    }

    /// One line, however many they are.
    void tell_late() {
        if (late_.empty()) return;
        constexpr std::size_t named = 8;
        std::string names;
        for (std::size_t i = 0; i < std::min(late_.size(), named); ++i) names += (i ? ", " : "") + late_[i];
        if (late_.size() > named) names += fmt::format(" and {} others", late_.size() - named);
        out_.notes.push_back(
            fmt::format("{} {} after the drive's next restart: switch it off and on.", names, late_.size() == 1 ? "counts" : "count"));
    }

    void finish() {
        tell_late();
        if (settings() == 0 && !wanted_.empty()) return;  // what was ordered is told, and nothing of it is kept or lost
        if (stores_each()) {
            out_.notes.push_back(fmt::format("{} stored in the EEPROM.", written_ == settings()
                                                                             ? count_text(written_, "value")
                                                                             : fmt::format("{} of {} values", written_, settings())));
            return;
        }
        if (out_.error) return;
        if (storing_ != Storing::asked) {
            if (profile_.storage.way == ParameterStorage::on_request) out_.notes.emplace_back(lost_at_power_off);
            return;
        }
        if (auto done = drive_.store_all(); !done) out_.error = done.error();
        else out_.notes.push_back("Stored in the EEPROM, all parameters of the drive at once.");
    }

    DriveAccess& drive_;
    const axes::DriveProfile& profile_;
    Storing storing_;
    std::vector<Change> wanted_;
    std::size_t written_ = 0;
    std::vector<std::string> late_;  ///< names of what does not count yet
    const DriveParameter* switched_ = nullptr;
    std::int64_t switched_from_ = 0;
    Written out_;
};

}  // namespace

Written write_values(DriveAccess& drive, const std::vector<config::ParameterSet::Value>& values, Storing storing) {
    return Writer(drive, storing).run(values);
}

int report_written(const BusOptions& options, const DriveAccess& drive, const Written& written) {
    if (options.json) {
        auto json = Json{{"ok", !written.error}, {"drive", drive.subject()}, {"changes", Json::array()}, {"notes", written.notes}};
        for (const auto& change : written.changes) json["changes"].push_back(change_json(change));
        if (written.error) json["error"] = error_json(*written.error);
        print_json(json);
        return written.error ? exit_code_for(*written.error) : static_cast<int>(exit_ok);
    }
    if (!written.changes.empty())
        fmt::print("{}: {} changed\n{}", drive.subject(), count_text(written.changes.size(), "value"),
                   changes_text(written.changes, colours_of_output()));
    else if (!written.error && written.acts == 0) fmt::print("{}: nothing to change\n", drive.subject());
    for (const auto& note : written.notes) fmt::print("{}\n", wrapped(note, 0));
    return written.error ? fail(options, *written.error) : static_cast<int>(exit_ok);
}

std::string changes_text(const std::vector<Change>& changes, Colours colours) {
    TextTable table{{{"parameter"}, {"name", TextTable::Column::Side::left, 40}, {"was"}, {"is"}}};
    for (const auto& change : changes)
        table.add({Cell{axes::name_of(*change.parameter), Tone::strong}, Cell{change.parameter->name},
                   Cell{change.from ? axes::value_text(*change.parameter, *change.from) : std::string("not readable")},
                   Cell{axes::value_text(*change.parameter, change.to), Tone::warning}});
    return table.empty() ? std::string{} : table.text(colours);
}

Json change_json(const Change& change) {
    return Json{{"parameter", axes::name_of(*change.parameter)},
                {"name", change.parameter->name},
                {"from", change.from ? Json(axes::value_text(*change.parameter, *change.from)) : Json()},
                {"to", axes::value_text(*change.parameter, change.to)}};
}

}  // namespace taktwerk::apps
