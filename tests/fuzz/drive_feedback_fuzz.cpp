// A drive behind real frames that says anything in its process data while an axis moves: what the axis then commands stays finite, inside
// its limits and without a jump. Input: [command], then lies: [cycles until then; with bit 7 it stays until the next], object, four bytes.
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <optional>

#include "axes/axis/axis.hpp"
#include "tests/axes/drives/cia402/scripted_drive.hpp"

using namespace taktwerk;
using namespace taktwerk::axes;
using namespace std::chrono_literals;

namespace {

/// 1000 counts are 1 u. Beside its lies it behaves: the motor is where it is told to be.
struct Rig : cia402::test::DriveRig {
    Rig() {
        if (!build()) std::abort();
        puppet->on_exchange = [this] { answer(); };
        AxisConfig config;
        config.gearing = {.counts_per_revolution = 10000, .motor_revolutions = 1, .load_revolutions = 1, .feed = 10};
        config.require_homed = false;
        limits = config.limits;
        axis = std::make_unique<Axis>(config, *drive, cycle);
        user = [this](Instant at) {
            axis->update(at);
            axis->supervise(at);
            (void)axis->power(true, true, true, Owner::program);
            axis->plan(at, cycle);
            axis->encode(at);
        };
    }
    struct Lie {
        std::size_t object = 0;
        std::int32_t value = 0;
        bool stays = false;
    };
    AxisLimits limits;
    std::unique_ptr<Axis> axis;
    std::optional<Lie> lie;

private:
    void answer() {
        static constexpr std::uint16_t ready = 0x0231, on = 0x0233, enabled = 0x1237, off = 0x0250;
        const auto word = control();
        const auto state = (word & 0xFu) == 15 ? enabled : (word & 0xFu) == 7 ? on : (word & 0xFu) == 6 ? ready : off;
        mode(got(0x6060));
        if (state == enabled) put(0x6064, got(0x607A));
        status(state);
        if (!lie) return;
        const auto [index, sub] = tx[lie->object % tx.size()];
        put(index, lie->value, sub);
        if (!lie->stays) lie.reset();
    }
};

AxisCommand command(std::uint8_t what) {
    switch (what % 4) {
        case 0: return {.kind = CommandKind::move_velocity, .velocity = 50};
        case 1: return {.kind = CommandKind::move_absolute, .position = 40, .velocity = 50};
        case 2: return {.kind = CommandKind::move_relative, .position = -30, .velocity = 20};
        default: return {.kind = CommandKind::halt};
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0 || size > 256) return -1;
    Rig rig;
    rig.run(200);
    (void)rig.axis->submit(command(data[0]), Owner::program);
    const auto step = [&] {
        const auto before = rig.axis->view();
        rig.run(1);
        const auto& view = rig.axis->view();
        for (const double value : {view.set_position, view.set_velocity, view.set_acceleration, view.actual_position, view.actual_velocity})
            if (!std::isfinite(value)) std::abort();
        if (std::abs(view.set_velocity) > rig.limits.velocity * (1 + 1e-9)) std::abort();
        // Without power the set-point follows the motor, wherever that says it is.
        if (before.powered && view.powered && std::abs(view.set_position - before.set_position) > rig.limits.velocity * 1e-3 * (1 + 1e-6))
            std::abort();
    };
    for (std::size_t at = 1; at + 6 <= size; at += 6) {
        for (int wait = data[at] % 32; wait > 0; --wait) step();
        std::int32_t value = 0;
        std::memcpy(&value, data + at + 2, sizeof value);
        rig.lie = Rig::Lie{data[at + 1], value, (data[at] & 0x80) != 0};
        step();
    }
    for (int i = 0; i < 100; ++i) step();
    return 0;
}
