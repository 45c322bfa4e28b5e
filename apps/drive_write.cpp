// Writing parameters with care for the EEPROM.

#include <fmt/format.h>

#include "apps/drive.hpp"
#include "axes/port/parameter_text.hpp"

namespace taktwerk::apps {

namespace {

using namespace std::chrono_literals;
using axes::DriveParameter;
using axes::ParameterStorage;

constexpr Duration between_stored_writes = 100ms;    // an EEPROM cell needs up to 10 ms; the drive does other things, too
constexpr Duration after_storing = 5s;               // longest stated: XP200 9.3, 5 s
constexpr std::int64_t signature_save = 0x65766173;  // "save", CiA 301 1010h

const DriveParameter* parameter_at(const axes::DriveProfile& profile, const axes::ParameterAddress& address) {
    for (const auto& parameter : profile.parameters)
        if (parameter.address == address) return &parameter;
    return nullptr;
}

/// The writing itself; stops at the first failure.
class Writer {
public:
    Writer(DriveAccess& drive, Storing storing) : drive_(drive), profile_(drive.profile()), storing_(storing) {}

    Written run(const std::vector<config::ParameterSet::Value>& values) {
        find_changes(values);
        if (out_.error || wanted_.empty()) return std::move(out_);
        if (may_store()) {
            prepare();
            for (const auto& change : wanted_) {
                if (out_.error) break;
                write(change);
            }
            if (!out_.error) finish();
        }
        return std::move(out_);
    }

private:
    void find_changes(const std::vector<config::ParameterSet::Value>& values) {
        for (const auto& value : values) {
            const auto now = drive_.read(*value.parameter);
            // What cannot be read is written unseen (SE-808X 6098h).
            if (now && *now == value.raw) continue;
            wanted_.push_back({value.parameter, now ? *now : value.parameter->value, value.raw});
        }
    }

    bool may_store() {
        if (storing_ != Storing::asked) return true;
        if (profile_.storage == ParameterStorage::never)
            out_.error = Error{"drive.cannot_store", drive_.subject(), "has no way to store parameters over the bus",
                               "leave --store away, and store with the maker's own tool"};
        else if (profile_.storage == ParameterStorage::not_stated)
            out_.error =
                Error{"drive.cannot_store", drive_.subject(), "its manual does not say how it stores parameters", "leave --store away"};
        return !out_.error;
    }

    /// A drive that stores each write is told not to, or left alone, as asked.
    void prepare() {
        if (profile_.storage != ParameterStorage::each_write) return;
        const auto* sw = profile_.storage_switch.index ? parameter_at(profile_, profile_.storage_switch) : nullptr;
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
            if (auto done = drive_.write(*sw, value); !done) out_.error = done.error();
            else out_.notes.push_back(note);
        };
        if (storing_ == Storing::volatile_only && *now != 0)
            set(0, fmt::format(
                       "{} was {}: now 0, so that these writes do not wear the EEPROM. They are lost at power off; --store keeps them.",
                       axes::name_of(*sw), *now));
        if (storing_ == Storing::asked) {
            restore_switch_ = *now == 0 ? sw : nullptr;
            if (*now == 0)
                set(sw->value, fmt::format("{} was 0: {} while these values are stored, then 0 again.", axes::name_of(*sw), sw->value));
        }
    }

    void write(const Change& change) {
        if (auto done = drive_.write(*change.parameter, change.to); !done) {
            out_.error = done.error();
            return;
        }
        out_.changes.push_back(change);
        if (const auto back = drive_.read(*change.parameter); back && *back != change.to)
            out_.error = Error{"drive.not_taken", fmt::format("{} {}", drive_.subject(), axes::name_of(*change.parameter)),
                               fmt::format("{} was written, but it reads {}", axes::value_text(*change.parameter, change.to),
                                           axes::value_text(*change.parameter, *back)),
                               "see in the manual when the drive takes this value"};
        if (change.parameter->effect == axes::ParameterEffect::after_restart)
            out_.notes.push_back(fmt::format("{} counts after the drive's next restart.", axes::name_of(*change.parameter)));
        if (storing_ == Storing::asked && profile_.storage == ParameterStorage::each_write) drive_.wait(between_stored_writes);
    }

    void finish() {
        if (restore_switch_)
            if (auto done = drive_.write(*restore_switch_, 0); !done) out_.error = done.error();
        if (storing_ != Storing::asked) {
            if (profile_.storage == ParameterStorage::on_request)
                out_.notes.push_back("The values are lost at power off; --store keeps them.");
            return;
        }
        if (profile_.storage == ParameterStorage::each_write) {
            out_.notes.push_back(fmt::format("{} stored in the EEPROM.", count_text(out_.changes.size(), "value")));
            return;
        }
        const auto* store = parameter_at(profile_, {0x1010, 1});
        if (!store) {
            out_.error = Error{"drive.cannot_store", drive_.subject(), "has no object 1010h:01 to store by", "leave --store away"};
            return;
        }
        if (auto done = drive_.write(*store, signature_save); !done) {
            out_.error = done.error();
            return;
        }
        drive_.wait(after_storing);
        out_.notes.push_back("Stored in the EEPROM, all parameters of the drive at once.");
    }

    DriveAccess& drive_;
    const axes::DriveProfile& profile_;
    Storing storing_;
    std::vector<Change> wanted_;
    const DriveParameter* restore_switch_ = nullptr;
    Written out_;
};

}  // namespace

Written write_values(DriveAccess& drive, const std::vector<config::ParameterSet::Value>& values, Storing storing) {
    return Writer(drive, storing).run(values);
}

std::string changes_text(const std::vector<Change>& changes, Colours colours) {
    TextTable table{{{"parameter"}, {"name", TextTable::Column::Side::left, 40}, {"was"}, {"is"}}};
    for (const auto& change : changes)
        table.add({Cell{axes::name_of(*change.parameter), Tone::strong}, Cell{change.parameter->name},
                   Cell{axes::value_text(*change.parameter, change.from)},
                   Cell{axes::value_text(*change.parameter, change.to), Tone::warning}});
    return table.empty() ? std::string{} : table.text(colours);
}

Json change_json(const Change& change) {
    return Json{{"parameter", axes::name_of(*change.parameter)},
                {"name", change.parameter->name},
                {"from", axes::value_text(*change.parameter, change.from)},
                {"to", axes::value_text(*change.parameter, change.to)}};
}

}  // namespace taktwerk::apps
