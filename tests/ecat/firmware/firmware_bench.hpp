#pragma once
// Three slaves on a cable, the middle one with firmware that can be written, and a probe: in virtual time.

#include <gtest/gtest.h>

#include <functional>

#include "ecat/diagnosis/bus_probe.hpp"
#include "ecat/diagnosis/derived_config.hpp"
#include "ecat/diagnosis/survey.hpp"
#include "ecat/firmware/firmware_update.hpp"
#include "tests/ecat/test_bus.hpp"

namespace taktwerk::ecat::test {

inline std::shared_ptr<DeviceDescription> gauge_description() {
    auto d = std::make_shared<DeviceDescription>();
    d->name = "gauge";
    d->device_name = "GAUGE";
    d->identity = {0x00000ABC, 0x00004711, 0x00010000, 0};
    d->mailbox = MailboxDescription{};
    d->mailbox->foe = true;
    d->mailbox->bootstrap = BootstrapDescription{0x1000, 0x100, 0x1100, 0x100};
    d->sync_managers = {{SmUse::mailbox_out, 0x1000, 0x80, 0x26}, {SmUse::mailbox_in, 0x1080, 0x80, 0x22}};
    d->objects = {{0x1009, 0, "Hardware", DataType::STRING, Access::ro, Mappable::no, 0, {}, {}, "B"},
                  {0x100A, 0, "Software", DataType::STRING, Access::ro, Mappable::no, 0, {}, {}, "?"}};
    return d;
}

class SilentGauge final : public sim::DeviceModel {
public:
    void power_on(sim::ObjectDictionary&, Instant) override {}
    void exchange(Instant) override {}
};

inline constexpr std::uint16_t gauge_place = 1;

class FirmwareBench {
public:
    explicit FirmwareBench(unsigned banks = 2, std::uint32_t password = 0,
                           std::shared_ptr<const DeviceDescription> description = gauge_description()) {
        sim::SlaveOptions options;
        options.firmware.banks = banks;
        options.firmware.password = password;
        network.add(terminal_description(), std::make_unique<InvertingTerminal>());
        network.add(description, std::make_unique<SilentGauge>(), options);
        network.add(terminal_description(), std::make_unique<InvertingTerminal>());
    }

    sim::SimSlave& gauge() { return network.slave(gauge_place); }
    static std::vector<std::byte> image(std::string_view version, std::uint32_t revision, std::uint32_t product = 0x4711) {
        return sim::firmware_image({0xABC, product, revision, 0}, version, 12'000);
    }
    static FirmwareSettings settings() {
        FirmwareSettings s;
        s.foe.patience.answer = 1s;
        s.foe.patience.busy = 2s;
        s.restart_patience = 3s;
        return s;
    }

    /// What the command does. `each`: at every look at the wire; false: the process is killed.
    Result<FirmwareOutcome> update(const std::vector<std::byte>& file, const std::function<bool()>& each = {}, std::uint32_t password = 0,
                                   FirmwareSettings with = settings()) {
        const auto round = [&](Duration period) -> std::optional<Instant> {
            now += period;
            if (each && !each()) return std::nullopt;
            return now;
        };
        BusProbe looking{transport, {}, round};
        const auto found = looking.run(survey(looking.port()));
        if (!found) return found.error();
        BusProbe probe{transport, derived_config(*found), round};
        adopt(probe.bus(), *found);
        return probe.run(update_firmware(probe.bus(), *probe.bus().slaves.at(gauge_place), {"firmware", password}, file, std::move(with)));
    }
    void wait(Duration time) {
        now += time;
        network.advance(now);
    }
    void power_cycle() {
        network.set_power(gauge_place, false);
        wait(100ms);
        network.set_power(gauge_place, true);
        wait(100ms);
    }
    /// What runs; empty: the boot loader alone.
    std::string running() {
        const auto& info = gauge().files()->flash().running();
        return info ? info->version : std::string{};
    }

    sim::SimNetwork network;
    LoopbackTransport transport{network};
    Instant now{};
};

}  // namespace taktwerk::ecat::test
