#pragma once
// Places on axes that never end: whole feeds and what is left, so that distance costs no precision. See exact_positions.md.

#include <cstdint>

namespace taktwerk::axes {

/// A place: feeds * feed + local. The feed (u per turn of the load) belongs to the axis and stands beside it.
struct EndlessPlace {
    std::int64_t feeds = 0;
    double local = 0;  ///< u

    friend bool operator==(const EndlessPlace&, const EndlessPlace&) = default;
};

/// From `from` to `to`, u.
[[nodiscard]] constexpr double way(const EndlessPlace& from, const EndlessPlace& to, double feed) noexcept {
    return static_cast<double>(to.feeds - from.feeds) * feed + (to.local - from.local);
}

/// A place and how it moves. u, u/s, u/s2.
struct EndlessMotion {
    EndlessPlace place{};
    double velocity = 0;
    double acceleration = 0;
    double trend =
        0;  ///< u/s; of a filtered master: its velocity without overshoot. In another sense than `velocity`: it does not move so. 0: not told
};

/// Where it was `seconds` before, had it moved with its acceleration all the time.
[[nodiscard]] constexpr EndlessMotion earlier(const EndlessMotion& now, double seconds) noexcept {
    return {{now.place.feeds, now.place.local - seconds * (now.velocity - seconds * now.acceleration / 2)},
            now.velocity - seconds * now.acceleration,
            now.acceleration};
}

}  // namespace taktwerk::axes
