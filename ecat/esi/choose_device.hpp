#pragma once
// Which device of a file is meant by a word: its type, its number in the list, or nothing where there is only one. Not real-time.

#include <cstdint>
#include <optional>
#include <string>

#include "ecat/esi/esi_file.hpp"

namespace taktwerk::ecat::esi {

/// `word`: a type ("EL3104", whatever the case), or the number in the list from 1; empty: the only product of the file. Of several revisions
/// of one type the newest, those that others replace last; `revision` asks for another one.
/// Errors: esi.no_device (nothing like it, with the nearest names), esi.which_device (several products).
[[nodiscard]] Result<std::size_t> choose_device(const EsiFile& file, const std::string& word, std::optional<std::uint32_t> revision);

}  // namespace taktwerk::ecat::esi
