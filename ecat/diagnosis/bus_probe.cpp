#include "ecat/diagnosis/bus_probe.hpp"

namespace taktwerk::ecat {

BusProbe::BusProbe(Transport& transport, BusConfig config, NextRound next_round)
    : config_(config), master_(transport, std::move(config)), next_round_(std::move(next_round)) {}

DatagramPort& BusProbe::port() noexcept { return master_.bus().port; }

std::optional<Instant> BusProbe::next_round() {
    // Longer or shorter as the machine's own runners do it: else no reference clock that drifts is ever locked to.
    const std::optional<Instant> now = next_round_(cycling_ ? config_.cycle + master_.period_correction() : pump_period);
    if (!now) return std::nullopt;
    if (cycling_) {
        master_.receive(*now);
        master_.send(*now);
    } else {
        master_.pump(*now);
    }
    master_.step(*now);
    return now;
}

Error BusProbe::interrupted() { return Error{"bus.interrupted", "", "ended before it was done", ""}; }

Result<void> BusProbe::bring_up() {
    cycling_ = true;
    master_.start();
    for (;;) {
        if (!next_round()) return interrupted();
        if (master_.phase() == Master::Phase::operational) return {};
        if (master_.phase() == Master::Phase::failed) return master_.failure();
    }
}

Result<void> BusProbe::run_for(Duration length) {
    std::optional<Instant> end;
    for (;;) {
        const std::optional<Instant> now = next_round();
        if (!now) return interrupted();
        if (!end) end = *now + length;
        if (*now >= *end) return {};
    }
}

Result<void> BusProbe::take_down() {
    master_.stop();
    while (master_.phase() != Master::Phase::stopped)
        if (!next_round()) return interrupted();
    cycling_ = false;
    return {};
}

Result<std::uint64_t> BusProbe::listen(Duration length) {
    // Sound frames of another source, and what is no sound frame: nothing was asked, so nothing of it is an answer.
    const auto heard = [this] { return master_.statistics().frames_foreign + master_.statistics().frames_rejected; };
    const std::uint64_t before = heard();
    const Result<void> waited = run_for(length);
    if (!waited) return waited.error();
    return heard() - before;
}

}  // namespace taktwerk::ecat
