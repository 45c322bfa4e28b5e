#pragma once
// The head of a recording as bytes, both ways. Not real-time.

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "runtime/recording_file/recording.hpp"

namespace taktwerk::runtime {

/// Texts are cut at 65,535 bytes.
[[nodiscard]] std::vector<std::byte> head_bytes(const RecordingInfo& info);
/// Nothing: they are no head.
[[nodiscard]] std::optional<RecordingInfo> read_head_bytes(std::span<const std::byte> bytes);

}  // namespace taktwerk::runtime
