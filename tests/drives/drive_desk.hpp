#pragma once
// The simulated drive of a drive file on a desk: its dictionary, its SDO server and its model, in virtual time, without slave controller,
// cable and master. For the worked examples of manuals, which are written as "write 6060h = 1, 6040h = 31, watch 6041h". Ranges, access
// rights, behaviour and alarms are the file's and the simulator's; expectations belong into the test, with the manual's section.
//
//     DriveDesk desk{"sv33-e"};                            // config/drives/sv33-e.yaml; powered, in PREOP, 1 ms a cycle
//     ASSERT_EQ(desk.sdo(0x6081, 0, 100000), 0u);          // by the messages of CoE: 0 or the abort code
//     desk.go_operational();
//     desk.pdo(0x6060, 1);                                 // as an RxPDO would: no checks, taken at the next cycle
//     desk.enable();                                       // 6 - 7 - 15, with the targets at the actual position
//     desk.pdo(0x607A, 50000);
//     desk.control(31);
//     EXPECT_TRUE(desk.status() & 0x1000);                 // 6041h
//     EXPECT_TRUE(desk.run_until([&] { return desk.status() & 0x0400; }, 2s));
//     desk.axis().fail(Failure::overload);                 // what may happen to it: Cia402Axis
//
// Further axes of a drive are reached by their own object numbers (TSVM: 6840h) and axis(1).

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <initializer_list>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
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

/// 10000 counts a turn, no limit in the way, a little friction.
inline axes::sim::PlantConfig long_table() {
    axes::sim::PlantConfig plant;
    plant.counts_per_revolution = 10000;
    plant.negative_limit = -1e9;
    plant.positive_limit = 1e9;
    plant.home_from = 1e9;
    plant.home_to = 2e9;
    return plant;
}

/// What no profile says because it depends on the motor or the maker's tool sets it: highest speed, how long it bears an overload, encoder;
/// and parameters of which the profile has the factory value.
using MotorFacts = std::function<void(axes::sim::SimulatedMotor&, axes::DriveProfile&)>;

class DriveDesk {
public:
    /// Powered, in PREOP.
    explicit DriveDesk(const std::string& name, const axes::sim::PlantConfig& plant = long_table(), Duration cycle_time = 1ms,
                       const MotorFacts& motor = {})
        : drive(drive_of_file(name)),
          dictionary(*drive.device),
          device(device_of(*drive.profile, plant, motor)),
          server_(*drive.device, dictionary, device),
          cycle_(cycle_time) {
        device.power_on(dictionary, now);
        enter(EsmState::preop);
    }
    DriveDesk(const DriveDesk&) = delete;
    DriveDesk& operator=(const DriveDesk&) = delete;

    // --- objects ----------------------------------------------------------------------------------------------------------
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
    [[nodiscard]] bool has(std::uint16_t index, std::uint8_t sub = 0) { return dictionary.find(index, sub) != nullptr; }
    /// An RxPDO's value: the low bits that the object holds, taken at the next cycle.
    void pdo(std::uint16_t index, std::int64_t value, std::uint8_t sub = 0) {
        auto* entry = dictionary.find(index, sub);
        if (!entry) throw std::out_of_range("the drive has no object " + std::to_string(index) + ':' + std::to_string(sub));
        entry->set(value);
    }

    // --- bus --------------------------------------------------------------------------------------------------------------
    /// What an empty mapping or an unfit cycle would make of it the drive decides: AL status code, 0 accepts.
    [[nodiscard]] std::uint16_t refuses(EsmState next) {
        ecat::sim::SyncSettings settings;
        settings.sync0_active = arrives.sync0;
        settings.sync0_cycle = cycle_;
        return device.refuse(state, next, settings);
    }
    void enter(EsmState next) {
        ASSERT_EQ(refuses(next), 0);
        state = next;
        device.entered(next, now);
    }
    void go_operational() {
        enter(EsmState::safeop);
        run(1ms);
        enter(EsmState::op);
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

    // --- time -------------------------------------------------------------------------------------------------------------
    void cycle() { cycle(cycle_); }
    /// `length` after the one before. Without SYNC0 and frames nothing is exchanged; SYNC0 runs in a drive whose clocks are on.
    void cycle(Duration length) {
        now += length;
        device.advance(now);
        if (state == EsmState::op && !arrives.outputs && !arrives.sync0) return;
        if (state == EsmState::op) device.exchange_due(arrives);
        device.exchange(now);
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) cycle();
    }
    void run(Duration length) {
        for (const Instant end = now + length; now < end;) cycle();
    }
    /// False: `patience` went by.
    template <typename Condition>
    bool run_until(Condition condition, Duration patience) {
        for (const auto end = now + patience; now < end; cycle())
            if (condition()) return true;
        return condition();
    }
    /// Writes the control word and runs.
    void control(std::uint16_t word, int cycles = 3) {
        pdo(0x6040, word);
        run(cycles);
    }
    /// One after the other, as a master walks through the states.
    void control(std::initializer_list<std::uint16_t> words) {
        for (const auto word : words) control(word);
    }
    /// 6 - 7 - 15 for the first axis; then as long as its brake needs.
    void enable() {
        control(6);
        control(7);
        pdo(0x607A, position());
        control(15);
        run(drive.profile->brake.release);
    }

    [[nodiscard]] unsigned status() { return static_cast<unsigned>(read(0x6041)) & 0xFFFFu; }
    [[nodiscard]] bool status_bit(unsigned n) { return (status() >> n & 1u) != 0; }
    /// State bits of the status word, CiA 402-2: 21h ready, 23h switched on, 27h enabled, 07h quick stop, 08h fault, 40h disabled.
    [[nodiscard]] unsigned power_state() {
        const unsigned word = status();
        return (word & 0x40u) != 0 ? word & 0x4Fu : word & 0x6Fu;
    }
    [[nodiscard]] bool enabled() { return (status() & 0x6Fu) == 0x27u; }
    [[nodiscard]] bool faulted() { return (status() & 0x4Fu) == 0x08u; }
    [[nodiscard]] std::int64_t position() { return read(0x6064); }
    [[nodiscard]] axes::sim::Cia402Axis& axis(std::size_t n = 0) { return device.axis(n); }
    /// Of the motor, counts/s: whatever unit 606Ch shows it in.
    [[nodiscard]] double speed() { return axis().plant().velocity(); }

    config::LoadedDrive drive;
    ecat::sim::ObjectDictionary dictionary;
    axes::sim::Cia402Device device;
    EsmState state = EsmState::init;
    Instant now{};
    ecat::sim::ExchangeCause arrives{.outputs = true, .sync0 = true};  ///< each cycle in OP; what a broken bus leaves out

private:
    static axes::sim::Cia402Device device_of(axes::DriveProfile profile, const axes::sim::PlantConfig& plant, const MotorFacts& facts) {
        axes::sim::SimulatedMotor motor{.counts_per_revolution = plant.counts_per_revolution};
        if (facts) facts(motor, profile);
        return axes::sim::Cia402Device{profile, std::vector<axes::sim::Cia402Device::AxisSetup>(profile.axes, {plant, motor})};
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

/// One that is in OP from the start.
class RunningDesk : public DriveDesk {
public:
    explicit RunningDesk(const std::string& name, const axes::sim::PlantConfig& plant = long_table(), Duration cycle_time = 1ms,
                         const MotorFacts& motor = {})
        : DriveDesk(name, plant, cycle_time, motor) {
        go_operational();
        run(2);
    }
};

}  // namespace taktwerk::test
