#pragma once
// A simulated drive made from its YAML file and driven object by object, in virtual time, without bus or master: for the worked examples of
// manuals, which are written as "write 6060h = 1, 6040h = 31, watch 6041h". The dictionary, its ranges and access rights, the behaviour and
// the alarms are the file's and the simulator's; expectations belong into the test, with the manual's section.
//
//     DriveBench drive{"sv33-e"};                          // config/drives/sv33-e.yaml; powered, in OP, 1 ms a cycle
//     drive.pdo(0x6060, 1);                                // as an RxPDO would: no checks, taken at the next cycle
//     ASSERT_EQ(drive.sdo(0x6081, 0, 100000), 0u);         // as an SDO would: 0 or the abort code
//     drive.enable();                                      // 6 - 7 - 15, with the targets at the actual position
//     drive.pdo(0x607A, 50000);
//     drive.pdo(0x6040, 31);
//     drive.run(2);
//     EXPECT_TRUE(drive.status() & 0x1000);                // 6041h
//     EXPECT_TRUE(drive.run_until([&] { return drive.status() & 0x0400; }, 2s));
//     drive.axis().fail(Failure::overload);                // what may happen to it: Cia402Axis
//
// Further axes of a drive are reached by their own object numbers (TSVM: 6840h) and axis(1).

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>

#include "axes/sim/cia402_device.hpp"
#include "config/drive_loader.hpp"
#include "ecat/sim/object_dictionary.hpp"

namespace taktwerk::axes::sim {

using namespace std::chrono_literals;

class DriveBench {
public:
    explicit DriveBench(const std::string& name, const PlantConfig& plant = long_table(), Duration cycle = 1ms)
        : loaded_(load(name)),
          cycle_(cycle),
          dictionary_(std::make_unique<ecat::sim::ObjectDictionary>(*loaded_.device)),
          device_(*loaded_.profile, setups(*loaded_.profile, plant)) {
        device_.power_on(*dictionary_, now_);
        (void)device_.refuse(ecat::sim::EsmState::preop, ecat::sim::EsmState::safeop, {true, cycle_, 0, 0});
        device_.entered(ecat::sim::EsmState::op, now_);
        run(2);
    }

    /// An RxPDO's value: the low bits that the object holds.
    void pdo(std::uint16_t index, std::int64_t value, std::uint8_t sub = 0) { entry(index, sub).set(value); }
    /// An SDO download: 0, or the abort code (CiA 301 table 22).
    [[nodiscard]] std::uint32_t sdo(std::uint16_t index, std::uint8_t sub, std::int64_t value) {
        auto* found = dictionary_->find(index, sub);
        if (!found) return dictionary_->has_object(index) ? 0x06090011 : 0x06020000;
        if (found->access() == ecat::Access::ro) return 0x06010002;
        if (found->maximum() && value > *found->maximum()) return 0x06090031;
        if (found->minimum() && value < *found->minimum()) return 0x06090032;
        if (const auto abort = device_.refuse_write(index, sub, value)) return abort;
        found->set(value);
        device_.written(index, sub, now_);
        return 0;
    }
    [[nodiscard]] std::int64_t read(std::uint16_t index, std::uint8_t sub = 0) { return entry(index, sub).get(); }
    [[nodiscard]] bool has(std::uint16_t index, std::uint8_t sub = 0) { return dictionary_->find(index, sub) != nullptr; }
    [[nodiscard]] unsigned status() { return static_cast<unsigned>(read(0x6041)) & 0xFFFFu; }
    [[nodiscard]] std::int64_t position() { return read(0x6064); }

    void cycle() {
        now_ += cycle_;
        device_.advance(now_);
        device_.exchange_due({.outputs = true, .sync0 = true});
        device_.exchange(now_);
    }
    void run(int cycles) {
        for (int i = 0; i < cycles; ++i) cycle();
    }
    /// False: `patience` went by.
    template <typename Condition>
    bool run_until(Condition condition, Duration patience) {
        for (const auto end = now_ + patience; now_ < end; cycle())
            if (condition()) return true;
        return condition();
    }
    /// Writes the control word and runs.
    void control(std::uint16_t word, int cycles = 3) {
        pdo(0x6040, word);
        run(cycles);
    }
    /// 6 - 7 - 15 for the first axis; then as long as its brake needs.
    void enable() {
        control(6);
        control(7);
        pdo(0x607A, position());
        control(15);
        (void)run_until([] { return false; }, loaded_.profile->brake_release);
    }

    [[nodiscard]] Cia402Axis& axis(std::size_t index = 0) { return device_.axis(index); }
    [[nodiscard]] Cia402Device& device() { return device_; }
    [[nodiscard]] const DriveProfile& profile() const { return *loaded_.profile; }
    [[nodiscard]] Instant now() const { return now_; }

    /// 10000 counts a turn, no limit in the way, a little friction.
    static PlantConfig long_table() {
        PlantConfig plant;
        plant.counts_per_revolution = 10000;
        plant.negative_limit = -1e9;
        plant.positive_limit = 1e9;
        plant.home_from = 1e9;
        plant.home_to = 2e9;
        return plant;
    }

private:
    static config::LoadedDrive load(const std::string& name) {
        auto loaded = config::load_drive(std::string(TAKTWERK_SOURCE_DIR) + "/config/drives/" + name + ".yaml");
        if (auto* drive = std::get_if<config::LoadedDrive>(&loaded)) return *drive;
        throw std::runtime_error(name + ".yaml: " + std::get<1>(loaded).front().what);
    }
    static std::vector<Cia402Device::AxisSetup> setups(const DriveProfile& profile, const PlantConfig& plant) {
        return std::vector<Cia402Device::AxisSetup>(profile.axes, {plant, personality_of(profile, plant.counts_per_revolution)});
    }
    ecat::sim::Entry& entry(std::uint16_t index, std::uint8_t sub) {
        if (auto* found = dictionary_->find(index, sub)) return *found;
        throw std::out_of_range("the drive has no object " + std::to_string(index) + ':' + std::to_string(sub));
    }

    config::LoadedDrive loaded_;
    Duration cycle_;
    Instant now_{};
    std::unique_ptr<ecat::sim::ObjectDictionary> dictionary_;
    Cia402Device device_;
};

}  // namespace taktwerk::axes::sim
