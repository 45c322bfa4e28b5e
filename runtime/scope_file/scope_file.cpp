#include "runtime/scope_file/scope_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "core/bytes.hpp"
#include "core/crc32.hpp"
#include "runtime/compression/compression.hpp"

namespace taktwerk::runtime {

namespace {

constexpr std::array<std::byte, 8> magic{std::byte{'T'}, std::byte{'W'}, std::byte{'S'}, std::byte{'C'},
                                         std::byte{'O'}, std::byte{'P'}, std::byte{'E'}, std::byte{0}};
constexpr std::size_t head_at = magic.size() + 8, block_head = 12, end_bytes = 8;

Error damaged(const std::string& subject, std::string what) {
    return {"recording.damaged", subject, std::move(what), "Take another recording; this file was changed or cut off."};
}

void split_planes(std::span<const std::uint64_t> columns, std::size_t words, std::vector<std::byte>& planes) {
    const auto rows = columns.size() / words;
    planes.resize(columns.size() * 8);
    for (std::size_t w = 0; w < words; ++w) {
        std::uint64_t before = 0;
        for (std::size_t row = 0; row < rows; ++row) {
            const auto value = columns[w * rows + row], step = value - before;
            before = value;
            for (std::size_t b = 0; b < 8; ++b) planes[(w * 8 + b) * rows + row] = static_cast<std::byte>(step >> 8 * b & 0xFF);
        }
    }
}

/// To the rows [at, at + rows) of columns that are `all` long.
void join_planes(std::span<const std::byte> planes, std::size_t words, std::size_t rows, std::span<std::uint64_t> columns, std::size_t all,
                 std::size_t at) {
    for (std::size_t w = 0; w < words; ++w) {
        std::uint64_t value = 0;
        for (std::size_t row = 0; row < rows; ++row) {
            std::uint64_t step = 0;
            for (std::size_t b = 0; b < 8; ++b) step |= std::to_integer<std::uint64_t>(planes[(w * 8 + b) * rows + row]) << 8 * b;
            value += step;
            columns[w * all + at + row] = value;
        }
    }
}

/// Of a block with its head, but for the place of the sum itself.
std::uint32_t block_sum(std::span<const std::byte> block) { return crc32(block.subspan(block_head), crc32(block.first(8))); }

struct Start {
    ScopeHead head;
    std::size_t blocks_at = 0;
};
Result<Start> parse_start(std::span<const std::byte> bytes, const std::string& subject) {
    if (bytes.size() < magic.size() || !std::equal(magic.begin(), magic.end(), bytes.begin()))
        return Error{"recording.no_recording", subject, "it is no recording of signals",
                     fmt::format("Give a file that a machine has kept around an alarm (*{}).", scope_ending)};
    if (bytes.size() < head_at + 4) return damaged(subject, "it ends in its head");
    const auto version = load_le<std::uint32_t>(bytes, magic.size()), length = load_le<std::uint32_t>(bytes, magic.size() + 4);
    if (version != scope_version)
        return Error{"recording.version", subject, fmt::format("it is of version {}, and this program reads {}", version, scope_version),
                     "Use the program that wrote it, or a newer one."};
    if (length > most_head_bytes || length > bytes.size() - head_at - 4) return damaged(subject, "it ends in its head");
    const auto summed = bytes.subspan(magic.size(), 8 + length);
    if (crc32(summed) != load_le<std::uint32_t>(bytes, head_at + length)) return damaged(subject, "the check sum of its head is wrong");
    const auto text = bytes.subspan(head_at, length);
    auto head = parse_head({reinterpret_cast<const char*>(text.data()), text.size()}, subject);
    if (!head) return head.error();
    return Start{std::move(*head), head_at + length + 4};
}

struct Block {
    std::size_t rows = 0;
    std::span<const std::byte> packed;
};
/// All blocks before the end mark, whose number of rows is theirs.
Result<std::vector<Block>> parse_blocks(std::span<const std::byte> bytes, std::size_t at, const std::string& subject) {
    std::vector<Block> blocks;
    std::uint64_t rows = 0;
    while (true) {
        if (bytes.size() - at < block_head) return damaged(subject, fmt::format("it was cut off behind {} rows", rows));
        const auto count = load_le<std::uint32_t>(bytes, at), length = load_le<std::uint32_t>(bytes, at + 4);
        if (count > most_block_rows || length > bytes.size() - at - block_head)
            return damaged(subject, fmt::format("it was cut off behind {} rows", rows));
        const auto block = bytes.subspan(at, block_head + length), packed = block.subspan(block_head);
        if (load_le<std::uint32_t>(block, 8) != block_sum(block))
            return damaged(subject, fmt::format("the check sum of the block behind {} rows is wrong", rows));
        at += block.size();
        if (count > 0) {
            blocks.push_back({count, packed});
            rows += count;
            continue;
        }
        if (length != end_bytes || load_le<std::uint64_t>(packed, 0) != rows || rows == 0 || at != bytes.size())
            return damaged(subject, "its end does not fit to what stands before");
        return blocks;
    }
}

Result<std::vector<std::byte>> file_bytes(const std::string& path) {
    const auto failed = [&] {
        return Error{"recording.open", path, fmt::format("the recording cannot be read: {}", std::strerror(errno)),
                     "Check the name; the log says where each recording was kept."};
    };
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file{std::fopen(path.c_str(), "rb"), &std::fclose};
    if (!file) return failed();
    std::vector<std::byte> out;
    std::array<std::byte, 65536> part;  // NOLINT(cppcoreguidelines-pro-type-member-init): read before it is used
    while (const auto got = std::fread(part.data(), 1, part.size(), file.get()))
        out.insert(out.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(got));
    if (std::ferror(file.get()) != 0) return failed();
    return out;
}

}  // namespace

Result<ScopeFileWriter> ScopeFileWriter::create(const std::string& path, const ScopeHead& head) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (!file)
        return Error{"recording.write", path, fmt::format("the recording cannot be written: {}", std::strerror(errno)),
                     "look at that folder and its disk: `recording: {directory: ...}`"};
    ScopeFileWriter writer{path, file, head.words};
    const auto json = head_json(head);
    std::vector<std::byte> start(head_at + json.size() + 4);
    std::ranges::copy(magic, start.begin());
    store_le<std::uint32_t>(start, magic.size(), scope_version);
    store_le<std::uint32_t>(start, magic.size() + 4, static_cast<std::uint32_t>(json.size()));
    std::memcpy(start.data() + head_at, json.data(), json.size());
    store_le<std::uint32_t>(start, head_at + json.size(), crc32(std::span{start}.subspan(magic.size(), 8 + json.size())));
    if (auto ok = writer.put(start); !ok) return ok.error();
    return writer;
}

Result<void> ScopeFileWriter::put(std::span<const std::byte> bytes) {
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
        return Error{"recording.write", path_, fmt::format("the recording is not complete: {}", std::strerror(errno)),
                     "look for free space on that disk"};
    bytes_ += bytes.size();
    return {};
}

Result<void> ScopeFileWriter::write(std::span<const std::uint64_t> columns) {
    const auto rows = columns.size() / words_;
    split_planes(columns, words_, planes_);
    packed_.assign(block_head, std::byte{0});
    compress(planes_, packed_);
    store_le<std::uint32_t>(packed_, 0, static_cast<std::uint32_t>(rows));
    store_le<std::uint32_t>(packed_, 4, static_cast<std::uint32_t>(packed_.size() - block_head));
    const std::span<const std::byte> block{packed_};
    store_le<std::uint32_t>(packed_, 8, block_sum(block));
    rows_ += rows;
    return put(block);
}

Result<void> ScopeFileWriter::finish() {
    std::array<std::byte, block_head + end_bytes> end{};
    store_le<std::uint32_t>(end, 4, end_bytes);
    store_le<std::uint64_t>(end, block_head, rows_);
    store_le<std::uint32_t>(end, 8, block_sum(end));
    if (auto ok = put(end); !ok) return ok;
    if (std::fflush(file_.get()) != 0 || ::fsync(::fileno(file_.get())) != 0)
        return Error{"recording.write", path_, fmt::format("the recording is not complete: {}", std::strerror(errno)),
                     "look for free space on that disk"};
    return {};
}

Result<KeptRows> parse_scope_file(std::span<const std::byte> bytes, const std::string& subject, std::size_t most_bytes) {
    auto start = parse_start(bytes, subject);
    if (!start) return start.error();
    const auto blocks = parse_blocks(bytes, start->blocks_at, subject);
    if (!blocks) return blocks.error();
    const auto words = start->head.words;
    std::size_t all = 0;
    for (const auto& block : *blocks) all += block.rows;
    if (all > most_bytes / 8 / words)
        return Error{"recording.too_large", subject,
                     fmt::format("its {} rows of {} words would take more than {} bytes", all, words, most_bytes),
                     "Keep fewer seconds: `recording: {before: ..., after: ...}`."};
    // What a block says it holds is known before anything of its size is allocated.
    for (const auto& block : *blocks)
        if (size_before_compression(block.packed) != block.rows * words * 8) return damaged(subject, "a block is not as long as its rows");
    std::vector<std::uint64_t> columns(all * words);
    std::vector<std::byte> planes;
    std::size_t at = 0;
    for (const auto& block : *blocks) {
        planes.resize(block.rows * words * 8);
        if (!decompress(block.packed, planes)) return damaged(subject, fmt::format("the block behind {} rows is damaged", at));
        join_planes(planes, words, block.rows, columns, all, at);
        at += block.rows;
    }
    return KeptRows{std::move(start->head), std::move(columns)};
}

Result<KeptRows> read_scope_file(const std::string& path) {
    const auto bytes = file_bytes(path);
    if (!bytes) return bytes.error();
    return parse_scope_file(*bytes, path);
}

Result<ScopeFileInfo> look_at_scope_file(const std::string& path) {
    const auto bytes = file_bytes(path);
    if (!bytes) return bytes.error();
    auto start = parse_start(*bytes, path);
    if (!start) return start.error();
    const auto blocks = parse_blocks(*bytes, start->blocks_at, path);
    if (!blocks) return blocks.error();
    ScopeFileInfo info{std::move(start->head), 0, bytes->size()};
    for (const auto& block : *blocks) info.rows += block.rows;
    return info;
}

}  // namespace taktwerk::runtime
