// Any bytes as a recording of signals: an error that says what and what to do, or rows whose signals all lie in them. Where the first byte is odd, the
// rest is a head (its length in the second byte, in units of 16), a number of rows and the packed bytes of one block; what chance would not
// find is put right: lengths, check sums, end mark.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "core/bytes.hpp"
#include "core/crc32.hpp"
#include "runtime/recording/thinned_read.hpp"
#include "runtime/scope_file/scope_file.hpp"

using namespace taktwerk;
using namespace taktwerk::runtime;

namespace {

using Bytes = std::vector<std::byte>;

void append(Bytes& to, std::uint32_t value) {
    to.resize(to.size() + 4);
    store_le<std::uint32_t>(std::span{to}, to.size() - 4, value);
}

Bytes with_head(std::span<const std::byte> in) {
    Bytes file;
    for (const char c : {'T', 'W', 'S', 'C', 'O', 'P', 'E', '\0'}) file.push_back(static_cast<std::byte>(c));
    const auto length = in.empty() ? 0 : std::min<std::size_t>(16 * std::to_integer<std::size_t>(in[0]), in.size() - 1);
    const auto head = in.subspan(in.empty() ? 0 : 1, length), rest = in.subspan(in.empty() ? 0 : 1 + length);
    append(file, scope_version);
    append(file, static_cast<std::uint32_t>(head.size()));
    file.insert(file.end(), head.begin(), head.end());
    append(file, crc32(std::span{file}.subspan(8)));
    const auto block = [&file](std::uint32_t rows, std::span<const std::byte> packed) {
        Bytes start;
        append(start, rows);
        append(start, static_cast<std::uint32_t>(packed.size()));
        append(start, crc32(packed, crc32(start)));
        file.insert(file.end(), start.begin(), start.end());
        file.insert(file.end(), packed.begin(), packed.end());
    };
    const auto rows = rest.empty() ? std::uint32_t{0} : std::to_integer<std::uint32_t>(rest[0]);
    if (rows > 0) block(rows, rest.subspan(1));
    std::array<std::byte, 8> all{};
    store_le<std::uint64_t>(all, 0, rows);
    block(0, all);
    return file;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span<const std::byte> in{reinterpret_cast<const std::byte*>(data) + 1, size - 1};
    const auto file = (data[0] & 1) != 0 ? with_head(in) : Bytes(in.begin(), in.end());
    const auto read = parse_scope_file(file, "fuzz.twscope", 1 << 20);
    if (!read) {
        if (read.error().code.empty() || read.error().what.empty() || read.error().remedy.empty()) std::abort();
        return 0;
    }
    if (read->depth() == 0 || read->words() == 0 || read->depth() * read->words() * 8 > 1 << 20) std::abort();
    std::vector<const RecordedSignal*> signals;
    for (const auto& signal : read->signals()) signals.push_back(&signal);
    ThinnedRead all{*read, signals, {0, read->span().last + 10, 3}};
    for (std::size_t cells = 100; !all.step(cells); cells = 100) {}
    for (const auto& values : all.values())
        if (values.size() != 2 * ((read->depth() + 2) / 3)) std::abort();
    return 0;
}
