#pragma once
// The simulated drive of a drive file on a desk: its dictionary, its SDO server and its model, without slave controller and cable. A test
// reads and writes objects as the manual's pages say: sdo() with the messages of CoE, pdo() as process data in OP does.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "axes/sim/cia402_device.hpp"
#include "core/bytes.hpp"
#include "ecat/sim/object_dictionary.hpp"
#include "ecat/sim/sdo_server.hpp"
#include "ecat/wire/sdo.hpp"
#include "tests/config/loaded_drive.hpp"

namespace taktwerk::test {

using namespace std::chrono_literals;
using ecat::sim::EsmState;

/// Read once, used by every desk of the process.
inline const config::LoadedDrive& drive_of_file(const std::string& name) {
    static std::map<std::string, config::LoadedDrive> read;
    const auto known = read.find(name);
    return known != read.end() ? known->second : read.emplace(name, config::drive(name)).first->second;
}

class DriveDesk {
public:
    /// What the maker's tool sets and no object shows.
    using Adapt = std::function<void(axes::sim::Personality&)>;

    /// Powered, in PREOP.
    DriveDesk(const std::string& name, const axes::sim::PlantConfig& plant, Duration cycle = 1ms, const Adapt& adapt = {})
        : drive(drive_of_file(name)),
          dictionary(*drive.device),
          device(*drive.profile, setups(*drive.profile, plant, adapt)),
          server_(*drive.device, dictionary, device),
          cycle_(cycle) {
        device.power_on(dictionary, now);
        enter(EsmState::preop);
    }

    /// Abort code; 0: written. The value goes with the size of the object.
    std::uint32_t sdo(std::uint16_t index, std::uint8_t sub, std::int64_t value) {
        const auto* entry = dictionary.find(index, sub);
        std::array<std::byte, 8> data{};
        store_le<std::int64_t>(data, 0, value);
        std::array<std::byte, 0x80> request{}, answer{};
        const auto size =
            ecat::encode_download_request(request, index, sub, std::span<const std::byte>{data}.first(entry ? entry->byte_size() : 4));
        return outcome(request, size, answer);
    }
    /// As the drive answers an upload; a refusal fails the test.
    std::int64_t read(std::uint16_t index, std::uint8_t sub = 0) {
        std::array<std::byte, 0x80> request{}, answer{};
        const auto size = ecat::encode_upload_request(request, index, sub);
        const auto length = server_.serve(std::span<const std::byte>{request}.first(size), answer, state, now);
        const auto message = ecat::parse_sdo(std::span<const std::byte>{answer}.first(length));
        const auto* entry = dictionary.find(index, sub);
        if (!entry || !message || message->kind != ecat::SdoKind::upload_response) {
            ADD_FAILURE() << std::hex << index << ":" << int{sub} << " cannot be read";
            return 0;
        }
        std::uint64_t raw = 0;
        for (std::size_t i = 0; i < message->data.size(); ++i) raw |= static_cast<std::uint64_t>(message->data[i]) << (8 * i);
        const unsigned unused = 64u - entry->bits();
        return entry->is_signed() ? static_cast<std::int64_t>(raw << unused) >> unused : static_cast<std::int64_t>(raw);
    }
    /// Abort code of an upload; 0: it can be read.
    std::uint32_t upload_abort(std::uint16_t index, std::uint8_t sub = 0) {
        std::array<std::byte, 0x80> request{}, answer{};
        return outcome(request, ecat::encode_upload_request(request, index, sub), answer);
    }
    /// Process data from the master; counts in OP.
    void pdo(std::uint16_t index, std::int64_t value) { dictionary.find(index, 0)->set(value); }

    void enter(EsmState next) {
        ecat::sim::SyncSettings settings;
        settings.sync0_active = true;
        settings.sync0_cycle = cycle_;
        ASSERT_EQ(device.refuse(state, next, settings), 0);
        state = next;
        device.entered(next, now);
    }
    void go_operational() {
        enter(EsmState::safeop);
        run(1ms);
        enter(EsmState::op);
    }
    void run(Duration length) {
        for (const Instant end = now + length; now < end;) {
            now += cycle_;
            device.advance(now);
            if (state == EsmState::op) device.exchange_due(arrives);
            device.exchange(now);
        }
    }
    /// Writes the control word and gives the drive two cycles.
    void control(std::uint16_t word) {
        pdo(0x6040, word);
        run(2 * cycle_);
    }
    /// One after the other, as a master walks through the states.
    void control(std::initializer_list<std::uint16_t> words) {
        for (const auto word : words) control(word);
    }
    /// The control supply goes and comes; afterwards PREOP.
    void power_cycle() {
        device.power_off(now);
        now += 5s;
        device.advance(now);
        dictionary.reset();
        device.power_on(dictionary, now);
        state = EsmState::init;
        enter(EsmState::preop);
    }

    [[nodiscard]] std::uint16_t status() { return static_cast<std::uint16_t>(read(0x6041)); }
    /// State bits of the status word, CiA 402-2: 21h ready, 23h switched on, 27h enabled, 08h fault, 40h disabled.
    [[nodiscard]] unsigned power_state() {
        const unsigned word = status();
        return (word & 0x40u) != 0 ? word & 0x4Fu : word & 0x6Fu;
    }
    [[nodiscard]] axes::sim::Cia402Axis& axis() { return device.axis(0); }

    config::LoadedDrive drive;
    ecat::sim::ObjectDictionary dictionary;
    axes::sim::Cia402Device device;
    EsmState state = EsmState::init;
    Instant now{};
    ecat::sim::ExchangeCause arrives{.outputs = true, .sync0 = true};  ///< each cycle in OP; what a broken bus leaves out

private:
    static std::vector<axes::sim::Cia402Device::AxisSetup> setups(const axes::DriveProfile& profile, const axes::sim::PlantConfig& plant,
                                                                  const Adapt& adapt) {
        auto personality = axes::sim::personality_of(profile, plant.counts_per_revolution);
        if (adapt) adapt(personality);
        return {profile.axes, {plant, personality}};
    }
    std::uint32_t outcome(std::span<const std::byte> request, std::size_t size, std::span<std::byte> answer) {
        const auto length = server_.serve(request.first(size), answer, state, now);
        const auto message = ecat::parse_sdo(std::span<const std::byte>{answer}.first(length));
        if (!message) return 0xFFFFFFFF;
        return message->kind == ecat::SdoKind::abort ? message->abort_code : 0;
    }

    ecat::sim::SdoServer server_;
    Duration cycle_;
};

}  // namespace taktwerk::test
