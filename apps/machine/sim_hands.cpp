#include "apps/machine/sim_hands.hpp"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/nearest_name.hpp"
#include "runtime/present_slaves.hpp"

namespace taktwerk::apps {

std::vector<SimWord> sim_words() {
    std::vector<SimWord> out;
    for (const auto& command : ecat::sim::fault_commands()) out.push_back({command.word, command.arguments, command.effect});
    for (const auto& word : happening_words()) out.push_back({word.word, word.arguments, word.effect});
    out.push_back({"after", "TIME COMMAND", "any of them, later"});
    return out;
}

SimHands::SimHands(runtime::World& world, const runtime::MachineConfig& machine)
    : machine_(machine), world_(world), injector_(world.network(), world.transport().faults), happenings_(world) {}

Result<SimHands::Order> SimHands::understand(const std::string& line) const {
    auto happening = parse_happening(line, machine_);
    if (happening) {
        const bool button = happening->kind == runtime::SimulationEvent::Kind::input && world_.is_single_bit(happening->target);
        if (button && happening->value != 0 && happening->value != 1)
            return Error{"fault.arguments", line,
                         fmt::format("input '{}' is a single bit, and {} is neither 0 nor 1", happening->target, happening->value),
                         fmt::format("write `input {0} 1` or `input {0} 0`", happening->target)};
        return Order{std::move(*happening)};
    }
    if (happening.error().code != "fault.unknown") return happening.error();
    auto fault = ecat::sim::parse_fault(line);
    if (!fault) {
        if (fault.error().code != "fault.unknown") return fault.error();
        std::vector<std::string> words;
        for (const auto& word : sim_words()) words.emplace_back(word.word);
        const auto near = nearest_name(line.substr(0, line.find(' ')), words);
        if (near.empty()) return fault.error();
        return Error{"fault.unknown", line, "there is no such word", fmt::format("did you mean '{}'?", near)};
    }
    std::vector<std::string> slaves{"master"};
    if (machine_.bus.ring) slaves.emplace_back("ring");
    for (const auto& slave : runtime::present_slaves(machine_)) slaves.push_back(slave.name);
    if (!fault->slave.empty() && std::find(slaves.begin(), slaves.end(), fault->slave) == slaves.end()) {
        const auto near = nearest_name(fault->slave, slaves);
        return Error{"fault.no_slave", fault->slave, "there is no such slave",
                     near.empty() ? fmt::format("there is: {}", fmt::join(slaves, ", ")) : fmt::format("did you mean '{}'?", near)};
    }
    return Order{std::move(*fault)};
}

Result<void> SimHands::carry_out(Order order, Instant now) {
    if (auto* happening = std::get_if<runtime::SimulationEvent>(&order)) {
        happenings_.take(std::move(*happening), now);
        return {};
    }
    return injector_.apply(std::get<ecat::sim::Fault>(order), now);
}

Result<void> SimHands::ask(const std::string& line) {
    auto order = understand(line);
    if (!order) return order.error();
    const std::lock_guard lock(mutex_);
    asked_.push_back(std::move(*order));
    return {};
}

Result<void> SimHands::happen(const std::string& line, Instant now) {
    auto order = understand(line);
    if (!order) return order.error();
    return carry_out(std::move(*order), now);
}

void SimHands::step(Instant now) {
    if (const std::unique_lock lock(mutex_, std::try_to_lock); lock.owns_lock() && !asked_.empty()) {
        for (auto& order : asked_) (void)carry_out(std::move(order), now).ok();  // what can be wrong, ask() has said
        asked_.clear();
    }
    injector_.step(now);
    happenings_.step(now);
}

}  // namespace taktwerk::apps
