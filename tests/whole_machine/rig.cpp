#include "tests/whole_machine/rig.hpp"

#include <algorithm>
#include <stdexcept>

namespace taktwerk::whole {

namespace {

constexpr std::uint64_t patience_for_answers = 50;  // cycles

/// What it may be the reason of.
std::optional<Deed> deed_of(const runtime::OperatorCommand& command) {
    using enum runtime::OperatorAction;
    switch (command.action) {
        case jog: return Deed::jog;
        case home: return Deed::home;
        case move_absolute: return Deed::move;
        case power: return command.flag ? Deed::power_on : Deed::power_off;
        case stop: return Deed::stop;
        case reset: return Deed::reset;
        case set_mode: return Deed::change_mode;
        case program_start: return Deed::start_program;
        case program_stop:
        case program_reset: return Deed::stop_program;
        case force: return Deed::force;
        default: return std::nullopt;
    }
}
bool is_of_an_axis(std::optional<Deed> deed) { return deed && *deed < Deed::change_mode; }

/// Stops the field or the rotor of a motor that turns.
bool shakes(const std::variant<Trouble, Deed>& what) {
    const auto* trouble = std::get_if<Trouble>(&what);
    if (trouble == nullptr) return false;
    const auto source = source_of(*trouble);
    return source == Source::bus || source == Source::drives || source == Source::host;
}

}  // namespace

std::string Happening::text() const {
    std::string out{std::visit([](auto one) { return name(one); }, what)};
    if (!at.empty()) out += " at " + at;
    return out;
}

Rig::Rig(std::string_view machine) : m(load(machine, disk.path().string())) {
    if (!m.machine) throw std::runtime_error("this machine cannot be built");
    history_.emplace((disk.path() / "alarms.sqlite").string(), 1000, [this](const AlarmFact& fact) { return m.machine->describe(fact); },
                     [this](std::string_view text) { tell("history: " + std::string(text)); });
    auto opened = runtime::FlightRecorder::open(*m.machine, m.machine->config().recording.directory, Duration{});
    if (opened) recorder_ = std::move(*opened);
    else problem("no recordings: " + opened.error().text());
    m.on_cycle = [this] { each_cycle(); };
}

Rig::~Rig() {
    m.on_cycle = {};
    for (auto& oracle : m.oracles) oracle.look_away("what it found is among the problems");
}

void Rig::tell(std::string line) {
    log.push_back(fmt::format("{:.3f} s: {}", to_seconds(now().time_since_epoch()), line));
    if (log.size() > 60) log.pop_front();
}

std::size_t Rig::begins(std::variant<Trouble, Deed> what, std::string at) {
    while (!happenings_.empty() && happenings_.front().to && now() - *happenings_.front().to > aftermath) {
        happenings_.pop_front();
        ++forgotten_;
    }
    happenings_.push_back({what, std::move(at), now(), {}});
    if (const auto* trouble = std::get_if<Trouble>(&what)) {
        tell(happenings_.back().text());
        ++done[std::string(name(*trouble))];
    }
    if (shakes(what)) {
        ++shaking_;
        places_.shaken();
    }
    return forgotten_ + happenings_.size() - 1;
}

void Rig::ended(std::size_t happening) {
    auto& one = happenings_[happening - forgotten_];
    if (one.to) return;
    one.to = now();
    if (shakes(one.what)) --shaking_;
    if (std::holds_alternative<Trouble>(one.what)) tell("over: " + one.text());
}

std::uint64_t Rig::submit(runtime::OperatorCommand command) {
    using enum runtime::OperatorAction;
    command.client = 1;
    command.sequence = ++sequence_;
    command.after = m.machine->levels_raised();
    const auto& axes = m.machine->layout().axes;
    const std::string at = command.axis < axes.size() ? axes[command.axis].name : "";
    Given given{.cycle = cycles_, .deed = deed_of(command), .axis = command.axis, .asks_for_reference = command.action == home};
    if (is_of_an_axis(given.deed)) given.at = at;
    ++commands;
    if (!m.machine->submit(command)) {
        ++answers;  // queue_full, to its sender
        return 0;
    }
    unanswered_[sequence_] = std::move(given);
    return sequence_;
}

std::uint64_t Rig::submit(runtime::OperatorAction action, std::uint16_t axis, bool flag, double value, double value2) {
    runtime::OperatorCommand command;
    command.action = action;
    command.axis = command.index = axis;
    command.flag = flag;
    command.value = value;
    command.value2 = value2;
    return submit(command);
}

void Rig::mode(runtime::Mode mode) {
    runtime::OperatorCommand command;
    command.action = runtime::OperatorAction::set_mode;
    command.mode = mode;
    (void)submit(command);
}

void Rig::each_cycle() {
    ++cycles_;
    const auto* snapshot = m.machine->latest();
    if (snapshot == nullptr) return;
    look_at_answers();
    look_at_alarms(*snapshot);
    if (shaking_ > 0) places_.shaken();
    if (auto wrong = places_.look(m); !wrong.empty()) problem(std::move(wrong));
    history_->look(*snapshot, now(), now().time_since_epoch() / 1us);
    history_->work(now());
    if (recorder_) {
        recorder_->look(*snapshot);
        (void)recorder_->work();
    }
}

void Rig::look_at_answers() {
    while (const auto answer = m.machine->next_answer()) {
        ++answers;
        last_answer_ = *answer;
        if (answer->answer != runtime::Answer::accepted)
            tell(fmt::format("command {} refused: {} {}", answer->sequence, static_cast<int>(answer->answer),
                             static_cast<int>(answer->error)));
        const auto given = unanswered_.find(answer->sequence);
        if (given == unanswered_.end()) {
            problem(fmt::format("command {} is answered twice, or was never given", answer->sequence));
            continue;
        }
        if (answer->answer == runtime::Answer::accepted) accepted(given->second);
        unanswered_.erase(given);
    }
    if (!unanswered_.empty() && cycles_ - unanswered_.begin()->second.cycle > patience_for_answers) {
        problem(fmt::format("command {} has no answer", unanswered_.begin()->first));
        unanswered_.clear();
    }
}

void Rig::accepted(const Given& given) {
    if (given.deed) happens(*given.deed, given.at);
    if (given.asks_for_reference) places_.asked_for_reference(given.axis);
}

void Rig::look_at_alarms(const runtime::Snapshot& snapshot) {
    still_.clear();
    for (std::size_t i = 0; i < snapshot.alarm_count; ++i) {
        const auto& alarm = snapshot.alarms[i];
        const Known key{alarm.fact.id, alarm.fact.source, alarm.fact.index, alarm.since.time_since_epoch().count()};
        still_.push_back(key);
        if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
        strongest = std::max(strongest, alarm.reaction);
        const auto words = m.machine->describe(alarm.fact);
        ++seen[words.name];
        tell(fmt::format("alarm {} of {}: {}", words.name, words.source, words.english));
        if (!explained(words.name, alarm.fact))
            problem(fmt::format("nobody knows why: {} of {}: {}", words.name, words.source, words.english));
    }
    known_.swap(still_);
}

bool Rig::is_at(const AlarmFact& fact, const std::string& at) const {
    if (at.empty()) return true;
    const auto& config = m.machine->config();
    const auto axis_is_there = [&](std::size_t axis) {
        const auto& binding = config.axes[axis];
        if (binding.axis.name == at || binding.slave == at || binding.follower.slave == at || binding.drive == at) return true;
        // What hangs on the same drive.
        for (const auto& other : config.axes)
            if (other.axis.name == at && !other.slave.empty() && (other.slave == binding.slave || other.slave == binding.follower.slave))
                return true;
        return false;
    };
    const auto& layout = m.machine->layout();
    switch (fact.source) {
        case AlarmSource::axis: return fact.index < config.axes.size() && axis_is_there(fact.index);
        case AlarmSource::slave: {
            if (fact.index >= layout.slaves.size()) return false;
            const auto& slave = layout.slaves[fact.index];
            if (slave == at) return true;
            return std::any_of(config.axes.begin(), config.axes.end(), [&](const auto& binding) {
                return binding.axis.name == at && (binding.slave == slave || binding.follower.slave == slave);
            });
        }
        case AlarmSource::program: return fact.index < layout.programs.size() && layout.programs[fact.index] == at;
        default: return true;
    }
}

/// A drive that searches its reference at a limit switch and is stopped there meets that switch as one: its own alarm, whoever stopped it.
bool Rig::stopped_at_its_switch(std::string_view alarm, const AlarmFact& fact) {
    if (alarm != "drive_fault" || fact.source != AlarmSource::axis) return false;
    const auto& view = m.axis(fact.index);
    return m.machine->config().axes[fact.index].axis.homing.kind == axes::HomingKind::drive && !view.homed &&
           (view.negative_limit_switch || view.positive_limit_switch);
}

/// It runs where it takes a free way to be: a motor without an encoder that was held, or starved, while it turned.
bool Rig::has_lost_steps(std::string_view alarm, const AlarmFact& fact) const {
    if ((alarm != "negative_limit_switch" && alarm != "positive_limit_switch") || fact.source != AlarmSource::axis) return false;
    const auto& binding = m.machine->config().axes[fact.index];
    return binding.profile && !binding.profile->encoder.present && !binding.encoder && !places_.sure(fact.index);
}

bool Rig::explained(std::string_view alarm, const AlarmFact& fact) {
    if (stopped_at_its_switch(alarm, fact) || has_lost_steps(alarm, fact)) return true;
    for (const auto& one : happenings_) {
        if (one.to && now() - *one.to > aftermath) continue;
        for (const auto& consequence : std::visit([](auto what) { return consequences(what); }, one.what))
            if (is(consequence, alarm) && (consequence.where == Where::anywhere || is_at(fact, one.at))) return true;
    }
    return false;
}

bool Rig::in_operation() const {
    const auto& bus = m.machine->bus();
    if (bus.phase() != ecat::Master::Phase::operational) return false;
    for (std::size_t s = 0; s < bus.slave_count(); ++s)
        if (!bus.health(s).fresh || bus.health(s).al_state != ecat::AlState::op) return false;
    return true;
}

bool Rig::any_in_error() {
    const auto& axes = m.state().axes;
    return std::any_of(axes.begin(), axes.end(), [](const auto& axis) { return axis.state == axes::AxisState::ErrorStop; });
}

std::string Rig::standing() {
    std::string out;
    const auto& snapshot = m.state();
    for (std::size_t i = 0; i < snapshot.alarm_count; ++i) {
        const auto words = m.machine->describe(snapshot.alarms[i].fact);
        out += fmt::format("{} of {}{}; ", words.name, words.source, snapshot.alarms[i].standing ? "" : " (gone)");
    }
    return out;
}

void Rig::gather() {
    for (auto& oracle : m.oracles) {
        if (oracle.clean()) continue;
        problem(oracle.report());
        oracle.look_away("told");
    }
}

std::string Rig::story() const {
    std::string out;
    for (const auto& line : log) out += "  " + line + "\n";
    return out;
}

}  // namespace taktwerk::whole
