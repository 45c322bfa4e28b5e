#pragma once
// A simulated XP200 on a computed line, and a host that asks it one thing after another.

#include <gtest/gtest.h>

#include <optional>

#include "axes/sim/xp200/station.hpp"
#include "config/drive_file/drive_loader.hpp"
#include "modbus/client/client.hpp"
#include "modbus/line/virtual_line.hpp"
#include "tests/patience.hpp"

namespace taktwerk::axes::sim::xp200 {

using namespace std::chrono_literals;

inline const DriveProfile& xp200_profile() {
    static const auto loaded = config::load_drive(TAKTWERK_SOURCE_DIR "/config/drives/xp200.yaml");
    const auto* drive = std::get_if<config::LoadedDrive>(&loaded);
    if (drive == nullptr) throw std::runtime_error(std::get<1>(loaded).front().text());
    return *drive->profile;
}

struct DriveRig {
    explicit DriveRig(const Options& options = {}, const PlantConfig& plant = {}) : drive(xp200_profile(), plant, options) {
        for (const auto& [number, value] : {std::pair{181, 1}, {4, 1}, {25, 1}, {108, 9}}) set(number, value);
        line.connect(drive);
    }
    /// At the panel, and saved.
    void set(int number, int value) { drive.servo().parameters().commission(static_cast<std::uint16_t>(number), value); }
    void start() {
        drive.servo().power_on(now);
        run(1600ms);
    }
    void run(Duration time) {
        now += time;
        line.advance(now);
    }
    modbus::Answer ask(const modbus::Request& request) {
        for (Patience patience; patience.lasts(client.ask(request, now) != modbus::Refusal::none);) now += 1ms;
        for (Patience patience; patience.lasts(true);) {
            now += 1ms;
            if (auto answer = client.step(now)) return *answer;
        }
        return {};
    }
    modbus::ExceptionCode refused(const modbus::Request& request) { return ask(request).response.exception; }
    void write(int number, int value) {
        const auto answer = ask(modbus::write_parameter(1, static_cast<std::uint16_t>(number), static_cast<std::uint16_t>(value)));
        EXPECT_EQ(answer.outcome, modbus::Outcome::answered) << "Pr" << number;
    }
    int read(int number) {
        return static_cast<std::int16_t>(ask(modbus::read_parameters(1, static_cast<std::uint16_t>(number), 1)).response.words[0]);
    }
    int status(int index) {
        return static_cast<std::int16_t>(ask(modbus::read_status(1, static_cast<std::uint16_t>(index), 1)).response.words[0]);
    }
    void enable(bool on = true) {
        EXPECT_EQ(ask(modbus::servo(1, on ? modbus::servo_on : modbus::servo_off)).outcome, modbus::Outcome::answered);
    }
    Servo& servo() { return drive.servo(); }

    modbus::VirtualLine line{modbus::LineSettings{}};
    Drive drive;
    modbus::Client client{line};
    Instant now{};
};

}  // namespace taktwerk::axes::sim::xp200
