#pragma once
// A Cia402Drive on the real master over a simulated slave whose objects say exactly what the test wants, in virtual time.
// Frames, mailbox, dead times are real; only the drive behind the slave controller is a puppet.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "axes/drives/cia402/cia402_drive.hpp"
#include "ecat/master.hpp"
#include "ecat/sim/device_model.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "ecat/sim/sim_network.hpp"
#include "ecat/transport/loopback.hpp"
#include "tests/axes/drives/cia402/puppet_device.hpp"

namespace taktwerk::axes::cia402::test {

using namespace std::chrono_literals;

/// Keeps what the master wrote, answers what the test put there.
class Puppet final : public ecat::sim::DeviceModel {
public:
    void power_on(ecat::sim::ObjectDictionary& dictionary, Instant) override { objects = &dictionary; }
    void exchange(Instant) override {
        if (on_exchange) on_exchange();
    }
    std::uint32_t refuse_write(std::uint16_t, std::uint8_t, std::int64_t) override { return refuse_downloads ? 0x08000022u : 0; }
    ecat::sim::ObjectDictionary* objects = nullptr;
    std::function<void()> on_exchange;
    bool refuse_downloads = false;  ///< "because of the present device state"
};

class DriveRig {
public:
    Objects rx{{0x6040, 0}, {0x6060, 0}, {0x607A, 0}};
    Objects tx{{0x6041, 0}, {0x6061, 0}, {0x6064, 0}, {0x606C, 0}, {0x6077, 0}, {0x603F, 0}, {0x60FD, 0}};
    Objects others{{0x2021, 9}, {0x2005, 0x0B}};
    DriveProfile profile;
    std::uint8_t axis = 0;
    Duration cycle = 1ms;
    std::vector<ecat::StartupSdo> startup;

    DriveRig() : network(Instant{}), transport(network) {
        profile.name = "puppet";
        profile.modes = {DriveMode::cyclic_position, DriveMode::homing};
        profile.homing_methods = {17, 18, 19, 20, 21, 22};
    }

    /// Bus up, objects resolved. False: see `refusal`.
    bool build() {
        auto d = device("puppet", rx, tx);
        for (const auto& [index, sub] : others) {
            d->objects.push_back(object(index, sub));
            if (const auto held = holds.find({index, sub}); held != holds.end()) d->objects.back().value = held->second;
        }

        ecat::BusConfig config;
        config.cycle = cycle;
        ecat::SlaveConfig slave;
        slave.name = "z_drive";
        slave.device = d;
        slave.position = 0;
        slave.dc = true;
        slave.startup = startup;
        config.slaves = {slave};
        auto model = std::make_unique<Puppet>();
        puppet = model.get();
        network.add(d, std::move(model), {});
        master = std::make_unique<ecat::Master>(transport, config);
        master->start();
        const auto phase = [&] { return master->phase(); };
        for (int i = 0; i < 20'000 && phase() != ecat::Master::Phase::operational && phase() != ecat::Master::Phase::failed; ++i)
            exchange();
        if (phase() != ecat::Master::Phase::operational) {
            refusal = master->failure();
            return false;
        }
        drive = std::make_unique<Cia402Drive>(*master, 0, axis, std::make_shared<DriveProfile>(profile), cycle, wants);
        if (auto ok = drive->resolve(); !ok) {
            refusal = ok.error();
            return false;
        }
        status(0x0250);
        run(5);
        return true;
    }

    // --- what the drive says ------------------------------------------------------------------------------------------------
    void put(std::uint16_t index, std::int64_t value, std::uint8_t sub = 0) { puppet->objects->find(index, sub)->set(value); }
    void status(std::uint16_t word) { put(0x6041, word); }
    void mode(std::int64_t code) { put(0x6061, code); }
    /// Status word and mode of a drive that is Operation enabled in CSP (SV33-E 3.4.1 with bits 4 and 9; bit 12: follows).
    void enabled() {
        status(0x1237);
        mode(8);
    }
    // --- what the drive was told ----------------------------------------------------------------------------------------------
    std::int64_t got(std::uint16_t index, std::uint8_t sub = 0) { return puppet->objects->value(index, sub); }
    std::uint16_t control() { return static_cast<std::uint16_t>(got(0x6040)); }
    /// Control word bits 0 to 3 (CiA 402): Enable operation.
    bool told_to_enable() { return (control() & 0x0F) == 0x0F; }
    /// Of an acyclic request, if it comes within 500 cycles.
    std::optional<Result<ServiceAnswer>> answer_to(ServiceTicket ticket) {
        std::optional<Result<ServiceAnswer>> answer;
        for (int i = 0; i < 500 && !answer; ++i) {
            run(1);
            answer = drive->service_answer(ticket);
        }
        return answer;
    }

    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) {
            exchange();
            if (on_cycle) on_cycle();
        }
    }
    const DriveFeedback& feedback() const { return feedback_; }

    std::map<std::pair<std::uint16_t, std::uint8_t>, std::int64_t> holds;  ///< what `others` read from the start
    AxisWants wants;                                                       ///< before build()
    DriveCommand command;
    std::unique_ptr<ecat::Master> master;
    std::unique_ptr<Cia402Drive> drive;
    ecat::sim::SimNetwork network;
    ecat::LoopbackTransport transport;
    Puppet* puppet = nullptr;
    Error refusal;
    Instant now{};
    std::function<void()> on_cycle;
    std::function<void(Instant)> user;  ///< decodes and encodes in the test's place: an axis

private:
    void exchange() {
        now += cycle;
        master->receive(now);
        if (drive && user) {
            user(now);
        } else if (drive) {
            feedback_ = drive->decode(now);
            drive->encode(command, now);
        }
        master->send(now);
        if (drive) drive->step(now);
        master->step(now);
    }
    DriveFeedback feedback_;
};

}  // namespace taktwerk::axes::cia402::test
