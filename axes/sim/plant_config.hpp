#pragma once
// The mechanics behind a simulated drive: motor, load, travel and switches. SI units at the motor shaft; positions along the
// travel in counts of the drive (0 = where the machine's own zero is, unknown to the drive until it homes).

#include <cstdint>
#include <limits>

#include "core/time.hpp"

namespace taktwerk::axes::sim {

/// Of an absolute encoder, which counts its turns on while the drive is off.
enum class Battery : std::uint8_t {
    good,
    low,    ///< still holds the turns
    empty,  ///< turns are forgotten when the drive loses power
};

/// What of the load hangs behind a shaft that twists. load_inertia 0: everything is one mass.
struct ElasticLoad {
    double load_inertia = 0;  ///< kg m2, part of PlantConfig::inertia
    double frequency = 0;     ///< Hz, of the load alone with the motor held: the anti-resonance
    double damping = 0;       ///< N m s/rad, between motor and load
};

/// Torque over the angle of the motor: magnets or a pump pull by it. amplitude 0: none.
struct Cogging {
    double amplitude = 0;  ///< N m
    double periods = 0;    ///< in a turn of the motor
};

/// The loops of the drive. Gains of a plainly tuned servo.
struct ServoGains {
    double position = 80;     ///< 1/s
    double velocity = 500;    ///< 1/s
    double integral = 12000;  ///< 1/s2
    double feed_forward = 1;  ///< part of the velocity of the target that is added to what the position loop asks for
};

struct PlantConfig {
    std::int64_t counts_per_revolution = 10000;
    double inertia = 2e-4;           ///< kg m2, motor and load together
    double viscous_friction = 1e-3;  ///< N m s/rad
    double coulomb_friction = 0.05;  ///< N m
    double breakaway_torque = 0;     ///< N m, friction at standstill; 0 = as Coulomb
    ElasticLoad elastic;
    Cogging cogging;
    ServoGains gains;
    double load_torque = 0;       ///< N m, constant (gravity); positive pushes to negative
    double rated_torque = 1.27;   ///< N m: 1.0 of the port
    double maximum_torque = 3.0;  ///< in rated torques
    Duration brake_closing{};     ///< from the drive's word until the holding brake holds; 0: it is never late
    // travel, in counts; infinite = none
    double start = 0;
    double negative_stop = -std::numeric_limits<double>::infinity();
    double positive_stop = std::numeric_limits<double>::infinity();
    double negative_limit = -std::numeric_limits<double>::infinity();  ///< switch active below
    double positive_limit = std::numeric_limits<double>::infinity();   ///< switch active above
    double home_from = 1, home_to = 0;                                 ///< switch active in between; from > to = no switch
    double home_every = 0;   ///< it comes again after so many, as on a turning load; 0 = there is one
    double index_pulse = 0;  ///< one of the encoder's index pulses; one each revolution
    Battery battery = Battery::good;
    struct Signal {
        double from = 1, to = 0;
        double every = 0;  ///< it repeats, as marks on a web do; 0 = there is one
    };
    Signal probe[2];  ///< what the drive's probe inputs see, active in between; from > to = never
};

}  // namespace taktwerk::axes::sim
