#include "hmi_bridge/history/alarm_watch.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "runtime/alarms.hpp"

namespace taktwerk::hmi {
namespace {

bool same(const AlarmFact& a, const AlarmFact& b) { return a.id == b.id && a.source == b.source && a.index == b.index; }

}  // namespace

std::int64_t AlarmWatch::utime_of(Instant at) const noexcept {
    return utime_ - std::chrono::duration_cast<std::chrono::microseconds>(now_ - at).count();
}

void AlarmWatch::describe(Known& alarm) const {
    auto words = describe_(alarm.fact);
    auto& row = alarm.told.row;
    row.name = std::move(words.name);
    row.source = std::move(words.source);
    row.english = std::move(words.english);
    row.chinese = std::move(words.chinese);
    row.cause = std::move(words.cause);
    row.remedy = std::move(words.remedy);
    row.manual = std::move(words.manual);
}

bool AlarmWatch::named(Known& alarm) const {
    auto& row = alarm.told.row;
    if (!recording_of_ || row.reaction < Reaction::stop_axis || !row.recording.empty() || now_ - alarm.since > settles) return false;
    row.recording = recording_of_(alarm.fact, alarm.since);
    return !row.recording.empty();
}

AlarmWatch::Known* AlarmWatch::fluttering(const AlarmFact& fact, Instant since, Reaction reaction) {
    if (reaction > Reaction::warn) return nullptr;
    const auto meant = [&](const Known& alarm) {
        return same(alarm.fact, fact) && alarm.told.row.state == AlarmState::gone && since - alarm.left <= flutters;
    };
    auto found = std::find_if(known_.begin(), known_.end(), meant);
    if (found == known_.end()) {
        const auto gone = std::find_if(left_.rbegin(), left_.rend(), meant);
        if (gone == left_.rend()) return nullptr;
        known_.push_back(std::move(*gone));
        left_.erase(std::next(gone).base());
        found = std::prev(known_.end());
    }
    auto& row = found->told.row;
    found->since = since;
    found->before = row.count++;
    found->listed = false;
    found->changed = true;
    row.state = AlarmState::stands;
    row.cleared_utime = row.acknowledged_utime = 0;
    return &*found;
}

AlarmWatch::Known& AlarmWatch::known(const AlarmFact& fact, Instant since, Reaction reaction) {
    const auto found = std::find_if(known_.begin(), known_.end(), [&](const Known& k) { return same(k.fact, fact) && k.since == since; });
    if (found != known_.end()) return *found;
    if (auto* again = fluttering(fact, since, reaction)) return *again;
    auto& alarm = known_.emplace_back();
    alarm.fact = fact;
    alarm.since = since;
    alarm.told.key = next_key_++;
    alarm.told.row.utime = utime_of(since);
    alarm.told.row.alarm = fact.id;
    alarm.told.row.reaction = reaction;
    describe(alarm);
    return alarm;
}

const AlarmWatch::Change& AlarmWatch::unseen(std::uint64_t more) {
    if (!unseen_ || now_ - unseen_->left > flutters) {
        constexpr auto alarm = runtime::id(runtime::MachineAlarm::alarm_log_full);
        unseen_.emplace(Known{});  // clang 14 takes it for not constructible without
        unseen_->fact = {alarm, AlarmSource::machine, 0, 0, 0};
        unseen_->told.key = next_key_++;
        auto& row = unseen_->told.row;
        row.alarm = alarm;
        row.utime = utime_of(now_);
        row.reaction = Reaction::warn;
        row.state = AlarmState::gone;
    }
    unseen_->fact.a += static_cast<double>(more);
    unseen_->left = now_;
    unseen_->told.row.cleared_utime = utime_of(now_);
    describe(*unseen_);
    return unseen_->told;
}

std::vector<AlarmWatch::Change> AlarmWatch::look(const runtime::Snapshot& snapshot, Instant now, std::int64_t utime) {
    now_ = now;
    utime_ = utime;
    for (auto& alarm : known_) alarm.listed = false;

    std::vector<Change> changes;
    const auto& passed = snapshot.passed_alarms;
    if (const auto more = std::max(next_passed_, passed.oldest()) - next_passed_; more > 0) {
        missed_ += more;
        changes.push_back(unseen(more));
    }
    for (auto number = std::max(next_passed_, passed.oldest()); number < passed.noted(); ++number) {
        const auto& gone = passed.at(number);
        auto& alarm = known(gone.fact, gone.since, gone.reaction);
        auto& row = alarm.told.row;
        alarm.left = gone.gone;
        alarm.listed = false;
        if (row.state == AlarmState::stands) row.cleared_utime = utime_of(gone.gone);
        else row.acknowledged_utime = utime_of(gone.gone);
        row.state = AlarmState::gone;
    }
    next_passed_ = passed.noted();

    for (std::size_t i = 0; i < snapshot.alarm_count && i < snapshot.alarms.size(); ++i) {
        const auto& listed = snapshot.alarms[i];
        auto& alarm = known(listed.fact, listed.since, listed.reaction);
        auto& row = alarm.told.row;
        alarm.listed = true;
        if ((row.state == AlarmState::stands) != listed.standing) {
            row.state = listed.standing ? AlarmState::stands : AlarmState::waits;
            row.cleared_utime = listed.standing ? 0 : utime_of(snapshot.at);
            alarm.changed = true;
        }
        if ((row.acknowledged_utime != 0) != listed.acknowledged) {
            row.acknowledged_utime = listed.acknowledged ? utime_of(snapshot.at) : 0;
            alarm.changed = true;
        }
        const auto times = alarm.before + listed.count;
        alarm.changed = alarm.changed || row.count != times;
        row.count = times;
        const bool other_numbers = alarm.fact.a != listed.fact.a || alarm.fact.b != listed.fact.b;
        if (!other_numbers || (!alarm.changed && now - alarm.since > settles)) continue;
        alarm.fact = listed.fact;
        alarm.changed = true;
        describe(alarm);
    }

    for (auto& alarm : known_) alarm.changed = named(alarm) || alarm.changed;
    for (auto& alarm : left_)
        if (named(alarm)) named_late_.push_back(alarm.told);

    for (auto& alarm : known_) {
        auto& row = alarm.told.row;
        if (!alarm.listed && row.state != AlarmState::gone) {
            // What waited for a person has left by a person; what held has ceased to.
            auto& left = row.state == AlarmState::stands ? row.cleared_utime : row.acknowledged_utime;
            left = utime_of(snapshot.at);
            row.state = AlarmState::gone;
            alarm.left = snapshot.at;
        }
        if (!alarm.listed || alarm.changed) changes.push_back(alarm.told);
        alarm.changed = false;
    }
    for (auto& alarm : known_)
        if (!alarm.listed) left_.push_back(std::move(alarm));
    std::erase_if(known_, [](const Known& alarm) { return !alarm.listed; });
    while (left_.size() > remembered) left_.pop_front();
    changes.insert(changes.end(), std::make_move_iterator(named_late_.begin()), std::make_move_iterator(named_late_.end()));
    named_late_.clear();
    return changes;
}

void AlarmWatch::name_recording(const AlarmFact& fact, Instant since, std::string recording) {
    const auto meant = [&](const Known& alarm) { return same(alarm.fact, fact) && alarm.since == since; };
    if (const auto found = std::find_if(known_.begin(), known_.end(), meant); found != known_.end()) {
        found->told.row.recording = std::move(recording);
        found->changed = true;
    } else if (const auto gone = std::find_if(left_.begin(), left_.end(), meant); gone != left_.end()) {
        gone->told.row.recording = std::move(recording);
        named_late_.push_back(gone->told);
    }
}

}  // namespace taktwerk::hmi
