#include "runtime/machine/bus_look.hpp"

#include "runtime/recording/asked_record.hpp"

namespace taktwerk::runtime {

void BusLook::step(Instant now) {
    if (!under_way()) return;
    auto& bus = body_.bus;
    const bool up = bus.phase() == ecat::Master::Phase::operational;
    if (wanted_) {
        wanted_ = false;
        if (body_.calls != nullptr) record_asked(*body_.calls, now, {AskedKind::ports});
        survey_ = ecat::known_survey(bus.bus());
        begun_ = now;
        // Before the bus is up its scripts have the datagrams; afterwards there is nobody who would carry one.
        if (up) runner_.emplace(ecat::look_at_ports(bus.bus(), survey_));
        return;
    }
    if (up) runner_->step(now);
    if (!up || runner_->done() || now - begun_ > patience) runner_.reset();
}

}  // namespace taktwerk::runtime
