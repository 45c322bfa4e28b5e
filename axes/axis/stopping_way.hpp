#pragma once
// A drive on a slow line that is told to stop brakes by itself, from where its motor is and from the speed that it has: it follows the set-point no more,
// and where the two come to rest is as far apart as they were in place and speed when it was told (in the middle of a reversal by a poll and a ramp). That
// is no following error. What is asked of the motor instead: that it stands after the way that its own ramp takes. Once it is told to follow again, what
// it was behind is forgiven as it makes it up, and no more than that. Real-time safe.

namespace taktwerk::axes {

class StoppingWay {
public:
    struct Sample {
        bool told_to_stop = false;
        double place = 0, velocity = 0;  ///< u, u/s, of the motor
        double error = 0;                ///< u, behind the set-point
        double speed = 0;                ///< u/s that it may have reached when it hears of the stop
        double deceleration = 0;         ///< u/s2 that it was told
        double latency = 0;              ///< s until it hears of it, and until that is seen
        double window = 0;               ///< u
    };
    /// u that the error may be beyond its window, at this sample.
    [[nodiscard]] double allowance(const Sample& now) noexcept;
    void clear() noexcept { *this = {}; }

private:
    bool stops_ = false;
    double from_ = 0, most_ = 0;  // u: where the motor was when it was told, and how far it may go from there
    double allowance_ = 0;
};

}  // namespace taktwerk::axes
