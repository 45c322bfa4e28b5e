#pragma once
// How many counts of a drive are one turn of its motor, from the objects that its profile names. Whoever asks brings the values: those
// that were read from a drive, those that a simulated one works with, or those that a machine file writes.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "axes/port/drive_profile.hpp"

namespace taktwerk::axes {

/// counts / per, a fraction that is not reduced.
struct DriveScale {
    std::int64_t counts = 0, per = 1;
    [[nodiscard]] bool is(std::int64_t counts_per_revolution) const noexcept { return counts == counts_per_revolution * per; }
    [[nodiscard]] double value() const noexcept { return static_cast<double>(counts) / static_cast<double>(per); }
};

/// The objects that have to be read for it, none twice. Empty: the drive has none.
[[nodiscard]] std::vector<ParameterAddress> scale_objects(const ScaleObjects& scale);

/// Nothing: it cannot be known from these values. Not real-time.
[[nodiscard]] std::optional<DriveScale> scale_of(const ScaleObjects& scale,
                                                 const std::function<std::optional<std::int64_t>(ParameterAddress)>& value_of);

/// "P01.05 x 6091h:02 / 6091h:01", for people.
[[nodiscard]] std::string scale_words(const DriveProfile& profile);

}  // namespace taktwerk::axes
