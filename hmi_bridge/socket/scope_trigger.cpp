#include "hmi_bridge/socket/scope_trigger.hpp"

#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "hmi_bridge/socket/unknown_signal.hpp"
#include "runtime/recording/cycle_at.hpp"

namespace taktwerk::hmi {
namespace {

using runtime::TriggerCondition;
using runtime::TriggerHunt;

constexpr std::array<std::string_view, 9> trigger_kinds{"rising", "falling", "either", "above", "below",
                                                        "inside", "outside", "bit",    "alarm"};
constexpr std::array<std::string_view, 3> trigger_modes{"single", "normal", "auto"};

Error bad_condition(std::string what, std::string remedy) { return {"scope.condition", "", std::move(what), std::move(remedy)}; }

template <std::size_t Count>
std::optional<std::size_t> place(const std::array<std::string_view, Count>& words, std::string_view word) {
    for (std::size_t i = 0; i < Count; ++i)
        if (words[i] == word) return i;
    return std::nullopt;
}

/// What the keys of this kind say.
Result<TriggerCondition> condition_of(JsonFields& when) {
    using Kind = TriggerCondition::Kind;
    const auto word = when.text("kind", true);
    if (when.error()) return *when.error();
    const auto kind = place(trigger_kinds, word);
    if (!kind)
        return bad_condition(fmt::format("there is no kind of trigger {}", shown(word)),
                             "Give rising, falling, either, above, below, inside, outside, bit or alarm.");
    TriggerCondition condition;
    condition.kind = static_cast<Kind>(*kind);
    if (condition.kind == Kind::alarm) return condition;
    if (condition.kind == Kind::bit) {
        const auto bit = when.maybe_count("bit");
        if (!when.error() && (!bit || *bit > 52))
            return bad_condition("\"bit\" is not a number from 0 to 52", "Give the bit, 0 is the lowest.");
        condition.bit = static_cast<unsigned>(bit.value_or(0));
        return condition;
    }
    condition.level = when.number("level", true);
    if (condition.kind != Kind::inside && condition.kind != Kind::outside) return condition;
    condition.level2 = when.number("level2", true);
    if (condition.level2 < condition.level)
        return bad_condition("\"level2\" is below \"level\": nothing lies between", "Give the lower bound as \"level\".");
    return condition;
}

}  // namespace

Result<void> ScopeTrigger::arm(ConnectionId connection, JsonFields& fields) {
    const auto* when = fields.object("when", true);
    TriggerHunt::Request request;
    request.pre = fields.maybe_count("pre").value_or(0);
    request.post = fields.maybe_count("post").value_or(0);
    request.holdoff = fields.maybe_count("holdoff").value_or(0);
    const auto mode_word = fields.text("mode", false);
    fields.finish();
    if (fields.error()) return *fields.error();
    const auto mode = mode_word.empty() ? std::optional<std::size_t>{0} : place(trigger_modes, mode_word);
    if (!mode) return bad_condition(fmt::format("there is no mode {}", shown(mode_word)), "Give single, normal or auto.");
    request.mode = static_cast<TriggerHunt::Mode>(*mode);

    JsonFields of_when(*when);
    const auto condition = condition_of(of_when);
    if (!condition) return condition.error();
    request.condition = *condition;
    std::string alarm;
    const auto& rows = *machine_.signals();
    if (condition->kind == TriggerCondition::Kind::alarm) {
        alarm = of_when.text("alarm", false);
    } else {
        const auto name = of_when.text("signal", true);
        const auto* signal = rows.find(name);
        if (!of_when.error() && !signal) return unknown_signal(rows, name);
        if (signal) request.cell = signal->cell;
    }
    of_when.finish();
    if (of_when.error()) return *of_when.error();
    hunts_.erase(connection);
    hunts_.emplace(connection, Armed{TriggerHunt{rows, request}, std::move(alarm)});
    return {};
}

std::string ScopeTrigger::state_json(ConnectionId connection) const {
    using Json = nlohmann::ordered_json;
    const auto there = machine_.signals()->span();
    const auto found = hunts_.find(connection);
    Json out{{"armed", found != hunts_.end() && found->second.hunt.armed()},
             {"looked_to", found != hunts_.end() ? found->second.hunt.looked_to() : there.last + 1},
             {"skipped", found != hunts_.end() ? found->second.hunt.skipped() : 0}};
    auto& events = out["events"] = Json::array();
    if (found != hunts_.end())
        for (const auto& event : found->second.hunt.events())
            events.push_back(Json{{"cycle", event.cycle},
                                  {"from", event.from},
                                  {"to", event.to},
                                  {"complete", there.last + 1 >= event.to},
                                  {"automatic", event.automatic}});
    return out.dump();
}

void ScopeTrigger::step(const runtime::Snapshot* snapshot) {
    if (hunts_.empty() || machine_.signals() == nullptr) return;
    if (snapshot != nullptr)
        alarms_.look(*snapshot, [&](const AlarmFact& fact, Reaction reaction, Instant since) {
            const auto cycle = runtime::cycle_at(*machine_.signals(), since);
            for (auto& [connection, armed] : hunts_)
                if (armed.alarm.empty() ? reaction >= Reaction::stop_axis : machine_.describe(fact).name == armed.alarm)
                    armed.hunt.offer(cycle);
            return true;  // once: its cycle leaves the memory, and whoever is armed later does not wait for what was there before
        });
    const auto told_to = snapshot != nullptr ? snapshot->cycle : 0;
    for (auto& [connection, armed] : hunts_) armed.hunt.step(rows_per_step, told_to);
}

}  // namespace taktwerk::hmi
