#include "tests/troubles/devices.hpp"

#include <algorithm>

#include "tests/ecat/test_bus.hpp"

namespace taktwerk::troubles {

namespace {

using namespace ecat;

/// A slave that exchanges whatever its PDOs carry.
class StillDevice final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
};

/// Its drive takes at most 1000 for 6085h, whatever is written.
class LimitingDevice final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary& dictionary, Instant) override { limited_ = dictionary.find(0x6085, 0); }
    void exchange(Instant) override {}
    void written(std::uint16_t index, std::uint8_t, Instant) override {
        if (index == 0x6085) limited_->set(std::min<std::int64_t>(limited_->get(), 1000));
    }

private:
    sim::Entry* limited_ = nullptr;
};

constexpr std::uint32_t module_ident = 0x11;

/// Two slots as ETG.5001 numbers them: objects +800h, PDOs +40h.
std::shared_ptr<DeviceDescription> modular() {
    auto d = test::servo_description();
    d->name = "robot";
    d->identity = {0x00000DEF, 0x00000022, 1, 0};
    d->dc = {};
    d->rx_pdos.clear(), d->tx_pdos.clear(), d->rx_assigned.clear(), d->tx_assigned.clear();
    d->rx_rules.max_assigned = d->tx_rules.max_assigned = 6;
    ModuleDescription csp{
        "csp", module_ident, {{0x1600, true, {{0x6040, 0, 16}, {0x607A, 0, 32}}, {}}}, {{0x1A00, true, {{0x6041, 0, 16}}, {}}}};
    ModuleDescription pp{"pp", 0x22, {{0x1601, true, {{0x6040, 0, 16}}, {}}}, {{0x1A01, true, {{0x6041, 0, 16}}, {}}}};
    d->slots = {2, 0x800, 0x40, false, {std::move(csp), std::move(pp)}};
    return d;
}

ObjectEntry number(std::uint16_t index, std::uint8_t sub, DataType type, Access access, std::int64_t value,
                   Mappable mappable = Mappable::no) {
    return {index, sub, "", type, access, mappable, value, {}, {}, {}};
}

/// As its firmware knows it: the PDOs of both slots, none of them assigned, and the lists of modules.
std::shared_ptr<DeviceDescription> played_modular() {
    auto d = modular();
    d->slots = {};
    d->rx_pdos = {{0x1600, true, {{0x6040, 0, 16}, {0x607A, 0, 32}}, {}}, {0x1640, true, {{0x6840, 0, 16}, {0x687A, 0, 32}}, {}}};
    d->tx_pdos = {{0x1A00, true, {{0x6041, 0, 16}}, {}}, {0x1A40, true, {{0x6841, 0, 16}}, {}}};
    d->objects.push_back(number(0x6840, 0, DataType::U16, Access::rw, 0, Mappable::rx));
    d->objects.push_back(number(0x687A, 0, DataType::I32, Access::rw, 0, Mappable::rx));
    d->objects.push_back(number(0x6841, 0, DataType::U16, Access::rw, 0, Mappable::tx));
    for (const std::uint16_t list : {std::uint16_t{0xF030}, std::uint16_t{0xF050}}) {
        const Access access = list == 0xF030 ? Access::rw : Access::ro;
        d->objects.push_back(number(list, 0, DataType::U8, access, 2));
        d->objects.push_back(number(list, 1, DataType::U32, access, module_ident));
        d->objects.push_back(number(list, 2, DataType::U32, access, module_ident));
    }
    return d;
}

}  // namespace

std::shared_ptr<DeviceDescription> device_of(char kind) {
    if (kind == 't' || kind == 'k' || kind == 'e') {
        auto d = test::terminal_description();
        if (kind == 'k') d->name = "coupler", d->identity.product = 0x00000500, d->ebus_current = std::int16_t{-500};
        if (kind == 'e') d->name = "valves", d->identity.product = 0x00000300, d->ebus_current = std::int16_t{300};
        return d;
    }
    if (kind == 'o') {
        auto d = test::terminal_description();
        d->name = "junction", d->identity.product = 0x00000501;
        d->sync_managers.clear(), d->rx_pdos.clear(), d->tx_pdos.clear(), d->rx_assigned.clear(), d->tx_assigned.clear();
        return d;
    }
    if (kind == 'm') return modular();
    auto d = test::servo_description();
    if (kind == 'v') d->identity.vendor = 0x00000666;
    if (kind == 'p') d->identity.product = 0x000C0109;
    if (kind == 'r') d->identity.revision = 0x00010000;
    return d;
}

std::shared_ptr<DeviceDescription> played(char kind) {
    if (kind == 'm') return played_modular();
    auto d = device_of(kind);
    if (kind == 'n') d->dc = {};
    if (kind == 'y') d->dc.cycles = {std::chrono::milliseconds{2}};
    if (kind == 'x') d->sync_managers[0].size = d->sync_managers[1].size = 0x100, d->sync_managers[1].start = 0x1200;
    if (kind == 'f') d->rx_pdos[1].entries = {{0x6040, 0, 16}, {0x607A, 0, 32}};
    return d;
}

std::unique_ptr<sim::DeviceModel> model_of(char kind) {
    if (kind == 't' || kind == 'k' || kind == 'e') return std::make_unique<test::InvertingTerminal>();
    if (kind == 'm' || kind == 'n' || kind == 'o') return std::make_unique<StillDevice>();
    if (kind == 'l') return std::make_unique<LimitingDevice>();
    return std::make_unique<test::EchoServo>();
}

}  // namespace taktwerk::troubles
