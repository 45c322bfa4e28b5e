#include "apps/machine/machine_log.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include "axes/axis/alarms.hpp"
#include "ecat/alarms.hpp"
#include "ecat/bringup/bus.hpp"
#include "hmi_bridge/words/event_text.hpp"
#include "runtime/alarms.hpp"

namespace taktwerk::apps {

using namespace runtime;

namespace {

/// A note that comes again is told so often at most, but for one that is twice as bad as what was told.
constexpr Duration notes_apart = std::chrono::seconds{10};

std::string_view text(Mode mode) {
    switch (mode) {
        case Mode::automatic: return "automatic";
        case Mode::setup: return "set-up";
        case Mode::manual: break;
    }
    return "manual";
}

std::string_view text(ProgramState state) {
    switch (state) {
        case ProgramState::running: return "running";
        case ProgramState::fault: return "fault";
        case ProgramState::stopped: break;
    }
    return "stopped";
}

/// What a drive itself announces, by its number and the detail of it.
bool of_a_drive(const AlarmFact& fact) {
    return fact.source == AlarmSource::axis &&
           (fact.id == axes::id(axes::AxisAlarm::drive_fault) || fact.id == axes::id(axes::AxisAlarm::drive_warning));
}

bool same_alarm(const AlarmFact& a, const AlarmFact& b) { return a.id == b.id && a.source == b.source && a.index == b.index; }

/// The bus says at once that slaves fell, and some milliseconds later why, and how many.
bool bus_tells_more(const AlarmFact& before, const AlarmFact& now) {
    switch (now.id) {
        case ecat::id(ecat::BusAlarm::slave_left_op): return before.a == 0 && now.a != 0;
        case ecat::id(ecat::BusAlarm::starved_slave_left_op):
        case ecat::id(ecat::BusAlarm::starved_slave_dropped_out): return now.b > before.b;
        case ecat::id(ecat::BusAlarm::foreign_command):
        case ecat::id(ecat::BusAlarm::foreign_command_tolerated): return now.a > before.a;
        default: return false;
    }
}

/// Whoever ends the run knows that it ends, and that its bus does.
bool ends_the_run(const AlarmText& words) { return words.name == "stopped_by_signal" || words.name == "bus_not_operational"; }

}  // namespace

void MachineLog::print(std::string lines) {
    std::fwrite(lines.data(), 1, lines.size(), stdout);
    std::fflush(stdout);
}

MachineLog::MachineLog(Machine& machine, Instant start, bool json, Sink sink)
    : MachineLog(machine, start,
                 [json, sink = std::move(sink)](const LogEntry& entry) { sink(json ? json_line(entry) : text_lines(entry)); }) {}

void MachineLog::say(Instant now, const std::string& event, const std::string& what) const {
    sink_({to_seconds(now - start_), event, what});
}

void MachineLog::say_alarm(Instant now, const std::string& event, const AlarmText& words) {
    const auto reaction = words.reaction == "none" ? std::string{} : fmt::format(" [{}]", words.reaction);
    sink_({to_seconds(now - start_), event, fmt::format("{}: {}{}", words.source, words.english, reaction), {}, &words});
}

void MachineLog::note(Instant now, const AlarmFact& fact, bool is_new, const std::string& event) {
    const auto known = std::find_if(notes_.begin(), notes_.end(), [&](const Noted& n) { return same_alarm(n.fact, fact); });
    const bool worse = known != notes_.end() && std::abs(fact.a) > 2 * std::abs(known->fact.a);
    if (!is_new && !worse) return;
    const auto words = machine_.describe(fact);
    if (ends_the_run(words)) return;
    if (known == notes_.end()) {
        notes_.push_back({fact, now, 0});
        say_alarm(now, event, words);
        return;
    }
    if (!worse && now - known->said_at < notes_apart) {
        ++known->unsaid;
        return;
    }
    const auto before = known->unsaid == 0 ? std::string{} : fmt::format(" ({} more since the last line)", known->unsaid);
    *known = {fact, now, 0};
    say(now, event, fmt::format("{}: {}{}", words.source, words.english, before));
}

/// What the watch of the bus did: who left OP and why, who is back.
void MachineLog::bus_notes(Instant now) {
    const auto& bus = machine_.bus().bus();
    const auto& notes = bus.notes;
    if (bus.remembered < notes_of_bus_) notes_of_bus_ = 0;  // another bring-up
    const auto fresh = std::min<std::uint64_t>(bus.remembered - notes_of_bus_, notes.size());
    for (auto i = notes.size() - fresh; i < notes.size(); ++i) say(now, "bus", notes[i]);
    notes_of_bus_ = bus.remembered;
}

void MachineLog::alarms(Instant now, const Snapshot& s) {
    for (std::size_t i = 0; i < s.alarm_count; ++i) {
        const auto& alarm = s.alarms[i];
        Known* known = nullptr;
        for (auto& k : known_)
            if (same_alarm(k.fact, alarm.fact)) known = &k;
        const bool is_new = !known || (alarm.standing && !known->standing) || alarm.count != known->count || alarm.since != known->since;
        const bool other_numbers = known && (known->fact.a != alarm.fact.a || known->fact.b != alarm.fact.b);
        if (!known) {
            known_.push_back({});
            known = &known_.back();
        }
        const auto before = known->fact;
        known->fact = alarm.fact;
        known->since = alarm.since;
        known->is_note = alarm.reaction == Reaction::none;
        known->standing = alarm.standing;
        known->count = alarm.count;
        if (alarm.reaction == Reaction::none) {
            note(now, alarm.fact, is_new);
            continue;
        }
        const bool of_the_bus = !is_new && alarm.standing && bus_tells_more(before, alarm.fact);
        if (!is_new && !of_the_bus && !(alarm.standing && other_numbers && of_a_drive(alarm.fact))) continue;
        const auto words = machine_.describe(alarm.fact);
        if (ends_the_run(words)) continue;
        // The alarm is announced at once, with its code. Where several alarms of the drive share that code, the detail that tells them apart
        // is read some milliseconds later and completes it; where the code said all, the words are the same and nothing is said.
        if (!is_new && words.english == known->said) continue;
        known->said = words.english;
        say_alarm(now, of_the_bus || (!is_new && (before.a == alarm.fact.a || before.a == 0)) ? "detail" : "ALARM", words);
    }
    std::erase_if(known_, [&](const Known& k) {
        for (std::size_t i = 0; i < s.alarm_count; ++i)
            if (same_alarm(s.alarms[i].fact, k.fact)) return false;
        const auto words = machine_.describe(k.fact);
        if (k.is_note || ends_the_run(words)) return true;
        say(now, "gone", fmt::format("{}: {}", words.source, words.name));
        return true;
    });
}

void MachineLog::passed_alarms(Instant now, const Snapshot& s) {
    const auto& passed = s.passed_alarms;
    if (passed.oldest() > next_passed_)
        say(now, "missed", fmt::format("{} alarms came and went too fast to be shown", passed.oldest() - next_passed_));
    for (auto number = std::max(next_passed_, passed.oldest()); number < passed.noted(); ++number) {
        const auto& alarm = passed.at(number);
        const bool was_seen = std::any_of(known_.begin(), known_.end(),
                                          [&](const Known& k) { return same_alarm(k.fact, alarm.fact) && k.since == alarm.since; });
        if (!was_seen) note(now, alarm.fact, true, alarm.reaction == Reaction::none ? "note" : "ALARM");
    }
    next_passed_ = passed.noted();
}

/// Commands that were refused, or ended early.
void MachineLog::events(Instant now, const Snapshot& s) {
    for (std::size_t i = 0; i < s.event_count; ++i) {
        const auto& event = s.events[i];
        if (event.number <= last_event_) continue;
        if (event.number > last_event_ + 1 && i == 0)
            say(now, "missed", fmt::format("{} events of commands came too fast to be shown", event.number - last_event_ - 1));
        last_event_ = event.number;
        const auto words = hmi::describe(event, machine_.layout());
        sink_({to_seconds(now - start_), std::string(hmi::word(event.what)),
               fmt::format("{}: {}", hmi::event_subject(event, machine_.layout()), words.what), words.remedy});
    }
    if (s.events_dropped > events_dropped_)
        say(now, "missed", fmt::format("{} more commands were refused or aborted", s.events_dropped - events_dropped_));
    events_dropped_ = s.events_dropped;
}

/// Whoever reads "released" looks for the person who did it: an input that becomes readable again has nobody.
void MachineLog::emergency(Instant now, const Snapshot& s) {
    const bool unread = std::any_of(s.alarms.begin(), s.alarms.begin() + static_cast<std::ptrdiff_t>(s.alarm_count), [](const auto& alarm) {
        return alarm.fact.id == id(MachineAlarm::emergency_stop) && alarm.standing && alarm.fact.a == emergency_stop_unread;
    });
    const auto before = emergency_;
    emergency_ = !s.emergency_stop ? Emergency::none : unread ? Emergency::unread : Emergency::pressed;
    if (emergency_ == before) return;
    const bool was_unread = before == Emergency::unread;
    switch (emergency_) {
        case Emergency::unread: return say(now, "E-STOP", "cannot be read: counts as pressed");
        case Emergency::pressed: return say(now, "E-STOP", was_unread ? "can be read again: it is pressed" : "pressed");
        case Emergency::none: return say(now, "E-STOP", was_unread ? "can be read again: it is not pressed" : "released");
    }
}

void MachineLog::step(Instant now, const Snapshot* snapshot) {
    if (!snapshot) {
        const auto progress = machine_.bus_progress();
        // Each SDO is gone before one has read of it; the ones that fail are named by the error.
        const bool fleeting = progress.find(" writing ") != std::string::npos;
        if (progress != progress_ && !progress.empty() && !fleeting) say(now, "bus", progress);
        progress_ = progress;
        return;
    }
    const auto& s = *snapshot;
    const auto& layout = machine_.layout();
    if (first_) {
        first_ = false;
        states_.resize(s.axes.size());
        homed_.resize(s.axes.size());
        programs_.resize(s.programs.size());
        mode_ = s.mode;
        // What was before this log began is none of its business.
        const auto& passed = s.passed_alarms;
        for (next_passed_ = passed.oldest(); next_passed_ < passed.noted() && passed.at(next_passed_).since < start_;) ++next_passed_;
        say(now, "machine",
            fmt::format("running, {} mode, {} {}, cycle {} us{}", text(s.mode), s.axes.size(), s.axes.size() == 1 ? "axis" : "axes",
                        layout.cycle.count() / 1000, s.simulated ? ", SIMULATED bus" : ""));
    }
    bus_notes(now);
    passed_alarms(now, s);  // first: what follows below, follows from them
    alarms(now, s);
    if (s.mode != mode_) say(now, "mode", std::string(text(s.mode)));
    mode_ = s.mode;
    emergency(now, s);
    for (std::size_t i = 0; i < s.axes.size(); ++i) {
        const auto& view = s.axes[i];
        // Moves come and go too fast to read: what a person wants to know is power, homing, stops and errors.
        using S = axes::AxisState;
        const auto quiet = [](S state) {
            return state == S::DiscreteMotion || state == S::ContinuousMotion || state == S::SynchronizedMotion || state == S::Standstill;
        };
        if (view.state != states_[i] && !(quiet(view.state) && quiet(states_[i])))
            say(now, "axis " + layout.axes[i].name, fmt::format("{} -> {}", axes::name(states_[i]), axes::name(view.state)));
        if (view.homed != homed_[i] && s.phase == MachinePhase::running)
            say(now, "axis " + layout.axes[i].name, view.homed ? "homed" : "no longer homed");
        states_[i] = view.state;
        homed_[i] = view.homed;
    }
    for (std::size_t i = 0; i < s.programs.size(); ++i) {
        if (s.programs[i] != programs_[i]) say(now, "program", fmt::format("{} {}", layout.programs[i], text(s.programs[i])));
        programs_[i] = s.programs[i];
    }
    events(now, s);
}

}  // namespace taktwerk::apps
