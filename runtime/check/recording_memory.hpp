#pragma once
// The memory of the scope (`recording.depth`) against that of the computer: all of it is locked before the first cycle. Not real-time.

#include <cstddef>
#include <optional>

#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::runtime {

inline constexpr std::size_t much_recording_memory = 256'000'000;  ///< bytes: with more, people should know
inline constexpr std::size_t most_recording_share = 2;             ///< one of so many parts of the computer's memory, and no more

/// More than much_recording_memory: `remark.recording_memory`. `bytes`: of the ring that is `depth` deep; `installed`: the computer's, 0: not known.
[[nodiscard]] std::optional<Error> recording_remark(Duration depth, std::size_t bytes, std::size_t installed);
/// Errors: recording.memory, where it would take more than its share. Unknown fits.
[[nodiscard]] Result<void> recording_fits(Duration depth, std::size_t bytes, std::size_t installed);

}  // namespace taktwerk::runtime
