#include "axes/axis/axis_core.hpp"

#include <utility>

namespace taktwerk::axes {

AxisCore::AxisCore(AxisConfig config, DrivePort& port, Duration cycle, std::uint16_t index, AxisView* view)
    : own_view(view ? nullptr : std::make_unique<AxisView>()),
      body(std::move(config), port, cycle, index, view ? *view : *own_view),
      measured(body),
      plain(view ? *view : *own_view),
      runs(body),
      modes(body, runs),
      motion(body, measured),
      conduct(body, motion.now, motion.addition, motion.aim, motion.base, runs),
      gantry(body, measured, conduct),
      load(body, measured, conduct),
      guard(body, measured, motion.now, modes, motion.addition, motion.aim, motion.limits, motion.targets, conduct),
      retained(body, measured, conduct),
      intake(body, measured, motion.now, motion.aim, runs, modes, retained, conduct),
      supply(body, measured, motion.now, motion.aim, runs, modes, conduct),
      reset(body, measured, motion.now, conduct),
      jog(body, measured, motion.aim, conduct),
      probes(body, measured, runs),
      homing(body, measured, motion, runs, modes, probes, conduct, guard),
      parameters(body, motion.now, modes, view ? *view : *own_view),
      bounds(body, modes),
      output(body, measured, motion.now, modes, runs, homing.home, reset, probes, parameters, bounds, following),
      drive(body, measured, motion, modes, conduct, guard, output),
      coupling(body, measured, motion, runs, conduct),
      admission(body, measured, motion.now, conduct, motion.targets, motion.given, coupling.slave, homing.home, homing.steps,
                drive.switching, drive.profiles),
      settings(body, measured, motion.now, motion.addition, motion.aim, motion.given, conduct, coupling.slave, parameters),
      succession(body, measured, motion.now, motion.given, motion.aim, conduct, motion.targets, modes, homing.steps, homing.home,
                 drive.profiles, drive.switching, coupling.slave, settings, admission, jog),
      updates(body, measured, motion.now, motion.given, motion.addition, motion.aim, motion.targets, coupling.slave, drive.switching,
              admission),
      writer(*this, view ? *view : *own_view) {}

}  // namespace taktwerk::axes
