#include "ecat/sim/sim_slave.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ecat/sim/sii_image.hpp"

namespace taktwerk::ecat::sim {

namespace {

constexpr std::uint16_t sm_watchdog_expired = 0x001B;

ControllerSettings settings_of(const DeviceDescription& description, const SlaveOptions& options) {
    ControllerSettings settings;
    settings.fmmus = std::min<std::uint8_t>(description.fmmus, 16);
    settings.sync_managers = std::min<std::uint8_t>(description.sync_manager_count, 16);
    settings.process_ram = description.process_ram;
    settings.dc = description.dc.supported;
    settings.dc_64bit = description.dc.clock_64bit;
    settings.lrw = options.lrw;
    settings.bitwise_fmmu = options.bitwise_fmmu;
    return settings;
}

/// A slave without CoE has no dictionary: nothing but what a description always implies would be in it.
DeviceDescription dictionary_source(const DeviceDescription& description) {
    return description.mailbox && description.mailbox->coe ? description : DeviceDescription{};
}

}  // namespace

SimSlave::SimSlave(std::shared_ptr<const DeviceDescription> description, std::unique_ptr<DeviceModel> model, SlaveOptions options)
    : description_(std::move(description)),
      model_(std::move(model)),
      options_(std::move(options)),
      controller_(settings_of(*description_, options_),
                  EepromInterface{sii_image(*description_, options_.alias), options_.eeprom_read_time, options_.eeprom_write_time}),
      dictionary_(dictionary_source(*description_)),
      process_data_(*description_, dictionary_),
      al_(*description_, controller_, *model_,
          description_->mailbox ? &coe_.emplace(*description_, dictionary_, *model_, controller_, options_.response_delay) : nullptr,
          description_->mailbox ? &process_data_ : nullptr) {
    if (options_.name.empty()) options_.name = description_->name;
    model_->connect(coe_ ? &*coe_ : nullptr);
    missed_entry_ = dictionary_.find(0x1C32, 0x0B);
}

void SimSlave::power_on(Instant now) {
    controller_.power_on(now, options_.clock_start.count(), static_cast<std::int32_t>(std::lround(options_.drift_ppm * 1000.0)));
    dictionary_.reset();
    powered_ = true;
    outputs_valid_ = false;
    al_due_ = never;
    settled_ = now;
    missed_outputs_ = 0;
    model_->power_on(dictionary_, now);
    al_.power_on(now);
    schedule();
}

void SimSlave::power_off(Instant now) {
    if (!powered_) return;
    settle(now);
    powered_ = false;
    next_event_ = never;
    model_->power_off(now);
}

void SimSlave::process(std::span<MutableDatagram> datagrams, Instant at) noexcept {
    while (next_event_ <= at) fire(next_event_);
    // Plain inputs are sampled at the start of the frame that carries them away.
    if (!description_->mailbox && al_.exchanging()) latch_raw_inputs();
    for (auto& datagram : datagrams) controller_.execute(datagram, at);
    handle_events(at);
    schedule();
}

void SimSlave::fire(Instant now) noexcept {
    controller_.fire(now);
    if (al_due_ <= now) {
        al_due_ = never;
        settle(now);
        const bool exchanged = al_.exchanging();
        al_.request(controller_.al_control(), now);
        if (!exchanged && al_.exchanging()) {
            outputs_valid_ = false;
            if (Entry* cycle = dictionary_.find(0x1C32, 0x02); cycle != nullptr && controller_.sync0().runs())
                cycle->set(controller_.sync0().cycle().count());
            exchange(now);  // the inputs are valid from the first frame in SAFEOP on
        }
    }
    if (coe_ && coe_->next_event() <= now) {
        settle(now);
        coe_->step(al_.state(), now);
    }
    handle_events(now);
    schedule();
}

void SimSlave::handle_events(Instant now) noexcept {
    const unsigned events = controller_.take_events();
    if (events == 0) return;
    if ((events & event::al_control) != 0 && al_due_ == never) al_due_ = now + options_.transition_time;
    if (coe_ && (events & (event::mailbox_written | event::mailbox_read | event::repeat_request)) != 0) coe_->step(al_.state(), now);
    if ((events & event::watchdog) != 0 && al_.state() == EsmState::op) {
        settle(now);
        if (al_.outputs_sm()) controller_.clear_outputs(*al_.outputs_sm());
        outputs_valid_ = false;
        model_->outputs_lost(now);
        al_.fall_to_safeop(sm_watchdog_expired, now);
    }
    if (!al_.exchanging()) return;
    if (controller_.sync0().runs()) {
        if ((events & event::sync0) != 0) exchange(now);
    } else if ((events & (al_.outputs_sm() ? event::outputs : event::inputs_read)) != 0) {
        exchange(now);
    }
}

void SimSlave::exchange(Instant now) noexcept {
    settle(now);
    const auto outputs = al_.outputs_sm(), inputs = al_.inputs_sm();
    const bool fresh = outputs && controller_.take_fresh(*outputs);
    outputs_valid_ |= fresh;
    const bool op = al_.state() == EsmState::op;
    if (op && outputs && !fresh && controller_.sync0().runs()) {
        ++missed_outputs_;
        if (missed_entry_ != nullptr) missed_entry_->set(std::min<std::int64_t>(missed_outputs_, 0xFFFF));
    }
    const bool apply = op && outputs && outputs_valid_;
    if (description_->mailbox) {
        if (apply) process_data_.load_outputs(controller_.outputs(*outputs));
        model_->exchange(now);
        if (inputs) process_data_.store_inputs(controller_.inputs(*inputs));
    } else {
        if (apply) model_->raw_outputs(controller_.outputs(*outputs));
        model_->exchange(now);
        latch_raw_inputs();
    }
}

void SimSlave::latch_raw_inputs() noexcept {
    if (const auto inputs = al_.inputs_sm()) model_->raw_inputs(controller_.inputs(*inputs));
}

void SimSlave::settle(Instant now) noexcept {
    if (now <= settled_) return;
    settled_ = now;
    model_->advance(now);
}

void SimSlave::stick_mailbox(bool stuck) noexcept {
    if (!coe_) return;
    coe_->stick(stuck);
    if (powered_) coe_->step(al_.state(), settled_);  // what waited goes on from here
    schedule();
}

void SimSlave::schedule() noexcept {
    next_event_ = std::min(controller_.next_event(), al_due_);
    if (coe_) next_event_ = std::min(next_event_, coe_->next_event());
}

}  // namespace taktwerk::ecat::sim
