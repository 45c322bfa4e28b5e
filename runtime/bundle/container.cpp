#include "runtime/bundle/container.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <set>

#include <fmt/format.h>

namespace taktwerk::runtime {

namespace {

constexpr std::size_t block = 512;
constexpr std::size_t end_blocks = 2;
constexpr std::uint64_t largest_stamp = 0777'7777'7777;  // eleven octal digits

// POSIX.1-1988, "ustar": where each field of a header stands.
struct Field {
    std::size_t at, size;
};
constexpr Field name_field{0, 100}, mode_field{100, 8}, user_field{108, 8}, group_field{116, 8}, size_field{124, 12}, stamp_field{136, 12},
    sum_field{148, 8}, kind_field{156, 1}, magic_field{257, 8}, prefix_field{345, 155};

using Header = std::array<char, block>;

void put_octal(Header& header, Field field, std::uint64_t value) {
    const auto text = fmt::format("{:0{}o}", value, field.size - 1);
    std::copy_n(text.data(), field.size - 1, header.data() + field.at);
}

void put_text(Header& header, Field field, std::string_view text) { std::copy_n(text.data(), text.size(), header.data() + field.at); }

/// Where a long path is parted into prefix and name: at the first slash behind which the rest is short enough. 0: it stands whole in the name;
/// nothing: it cannot be parted.
std::optional<std::size_t> parting(std::string_view path) {
    if (path.size() <= name_field.size) return 0;
    const auto slash = path.find('/', path.size() - name_field.size - 1);
    if (slash == std::string_view::npos || slash == 0 || slash > prefix_field.size) return std::nullopt;
    return slash;
}

/// The one form of a header. The path is one that can be parted.
Header header_of(std::string_view path, std::uint64_t size, std::int64_t stamp) {
    Header header{};
    const auto parted = parting(path).value_or(0);
    put_text(header, name_field, parted == 0 ? path : path.substr(parted + 1));
    if (parted != 0) put_text(header, prefix_field, path.substr(0, parted));
    put_octal(header, mode_field, 0644);
    put_octal(header, user_field, 0);
    put_octal(header, group_field, 0);
    put_octal(header, size_field, size);
    put_octal(header, stamp_field, static_cast<std::uint64_t>(stamp));
    put_text(header, kind_field, "0");  // a regular file
    put_text(header, magic_field,
             std::string_view("ustar\0"
                              "00",
                              8));
    unsigned sum = 0;
    for (std::size_t i = 0; i < block; ++i)
        sum += i >= sum_field.at && i < sum_field.at + sum_field.size ? ' ' : static_cast<unsigned char>(header[i]);
    put_text(header, sum_field, fmt::format("{:06o}", sum) + std::string("\0 ", 2));
    return header;
}

}  // namespace

std::string ustar_header(std::string_view path, std::uint64_t size, std::int64_t stamp) {
    if (!parting(path)) path = path.substr(0, name_field.size);
    const auto header = header_of(path, size, std::max<std::int64_t>(0, stamp));
    return {header.data(), header.size()};
}

namespace {

std::string_view text_in(const Header& header, Field field) {
    const std::string_view all(header.data() + field.at, field.size);
    return all.substr(0, std::min(all.find('\0'), all.size()));
}

std::optional<std::uint64_t> octal_in(const Header& header, Field field) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i + 1 < field.size; ++i) {
        const char digit = header[field.at + i];
        if (digit < '0' || digit > '7') return std::nullopt;
        value = value * 8 + static_cast<std::uint64_t>(digit - '0');
    }
    return value;
}

/// What else a tar file may hold, in words; nothing: a regular file.
std::string_view kind_words(char kind) {
    switch (kind) {
        case '0': return {};
        case '1': return "a hard link";
        case '2': return "a symbolic link";
        case '3':
        case '4': return "a device";
        case '5': return "a folder";
        case '6': return "a pipe";
        default: return "an extension of tar";
    }
}

std::string shown(std::string_view path) {
    std::string out;
    for (const char c : path.substr(0, 80)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
    return path.size() > 80 ? out + "..." : out;
}

class ContainerReader {
public:
    ContainerReader(const ByteSource& source, const std::string& subject) : source_(source), subject_(subject) {}

    Result<Container> read() {
        if (source_.size() > largest_bundle)
            return too_large(fmt::format("it has {} bytes, and a bundle has at most {}", source_.size(), largest_bundle));
        for (;;) {
            Header header{};
            if (auto ok = block_at(at_, header); !ok) return ok.error();
            if (header == Header{}) break;
            if (auto ok = take(header); !ok) return ok.error();
        }
        if (out_.files.empty()) return not_a_bundle();
        Header second{};
        if (auto ok = block_at(at_ + block, second); !ok) return ok.error();
        if (second != Header{} || source_.size() != at_ + end_blocks * block) return damaged("it does not end where its last file does");
        return std::move(out_);
    }

private:
    Result<void> block_at(std::uint64_t offset, Header& header) {
        if (source_.size() < offset + block) {
            if (out_.files.empty()) return not_a_bundle();
            return damaged(fmt::format("it is cut short: {} bytes are not all of it", source_.size()));
        }
        return source_.read(offset, std::as_writable_bytes(std::span(header)));
    }

    Result<void> take(const Header& header) {
        const auto size = octal_in(header, size_field), stamp = octal_in(header, stamp_field);
        const std::string_view magic(header.data() + magic_field.at, magic_field.size);
        if (magic != std::string_view("ustar\0"
                                      "00",
                                      8) ||
            !size || !stamp)
            return out_.files.empty() ? not_a_bundle() : damaged(fmt::format("what stands at byte {} is no header of a file", at_));
        std::string path(text_in(header, prefix_field));
        if (!path.empty()) path += '/';
        path += text_in(header, name_field);
        if (const auto words = kind_words(header[kind_field.at]); !words.empty())
            return Error{"bundle.path", subject_, fmt::format("'{}' is {}, and a bundle holds files alone", shown(path), words), remedy};
        if (!is_packed_path(path))
            return Error{"bundle.path", subject_, fmt::format("'{}' is no path inside of a bundle", shown(path)), remedy};
        if (*size > largest_packed_file)
            return too_large(
                fmt::format("'{}' is said to have {} bytes, and a file has at most {}", shown(path), *size, largest_packed_file));
        if (!out_.files.empty() && static_cast<std::int64_t>(*stamp) != out_.stamp)
            return damaged(fmt::format("the header of '{}' is not as one is written", shown(path)));
        if (header != header_of(path, *size, static_cast<std::int64_t>(*stamp)))
            return damaged(fmt::format("the header of '{}' is not as one is written", shown(path)));
        if (!seen_.insert(path).second) return Error{"bundle.twice", subject_, fmt::format("it holds '{}' twice", shown(path)), remedy};
        if (out_.files.size() == most_packed_files) return too_large(fmt::format("it holds more than {} files", most_packed_files));
        const auto begin = at_ + block, blocks = (*size + block - 1) / block;
        if (source_.size() < begin + blocks * block)
            return damaged(fmt::format("it is cut short in '{}': {} bytes are not all of it", shown(path), source_.size()));
        if (const auto rest = blocks * block - *size; rest > 0) {
            std::array<std::byte, block> filling{};
            if (auto ok = source_.read(begin + *size, std::span(filling).first(rest)); !ok) return ok.error();
            if (std::any_of(filling.begin(), filling.end(), [](std::byte b) { return b != std::byte{0}; }))
                return damaged(fmt::format("something stands behind the end of '{}'", shown(path)));
        }
        out_.stamp = static_cast<std::int64_t>(*stamp);
        out_.files.push_back({std::move(path), begin, *size});
        at_ = begin + blocks * block;
        return {};
    }

    static constexpr const char* remedy = "do not install it: `taktwerk bundle make` writes no such file, so somebody has changed it";
    [[nodiscard]] Error not_a_bundle() const {
        return {"bundle.not_a_bundle", subject_, "it does not begin as a bundle does", "name what `taktwerk bundle make` has written"};
    }
    [[nodiscard]] Error damaged(std::string what) const { return {"bundle.damaged", subject_, std::move(what), "copy it again"}; }
    [[nodiscard]] Error too_large(std::string what) const { return {"bundle.too_large", subject_, std::move(what), remedy}; }

    const ByteSource& source_;
    const std::string& subject_;
    Container out_;
    std::set<std::string, std::less<>> seen_;
    std::uint64_t at_ = 0;
};

}  // namespace

bool is_packed_path(std::string_view path) {
    if (path.empty() || path.size() > longest_packed_path) return false;
    if (std::any_of(path.begin(), path.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f || c == '\\'; }))
        return false;
    for (std::size_t begin = 0; begin <= path.size();) {
        const auto end = std::min(path.find('/', begin), path.size());
        const auto name = path.substr(begin, end - begin);
        if (name.empty() || name == "." || name == "..") return false;
        begin = end + 1;
    }
    return parting(path).has_value();
}

Result<Container> read_container(const ByteSource& source, const std::string& subject) { return ContainerReader(source, subject).read(); }

Result<void> ContainerText::add(const std::string& path, std::string_view bytes) {
    if (!is_packed_path(path))
        return Error{"bundle.path", path, "a bundle cannot hold a file of this path",
                     fmt::format("give it a shorter one, of at most {} bytes", name_field.size)};
    if (bytes.size() > largest_packed_file || text_.size() + bytes.size() + 4 * block > largest_bundle || files_ == most_packed_files)
        return Error{"bundle.too_large", path,
                     fmt::format("with it the bundle would have more than {} bytes or {} files", largest_bundle, most_packed_files),
                     "leave out what the machine does not need"};
    const auto header = header_of(path, bytes.size(), std::clamp<std::int64_t>(stamp_, 0, largest_stamp));
    text_.append(header.data(), header.size());
    text_.append(bytes);
    text_.append((block - bytes.size() % block) % block, '\0');
    ++files_;
    return {};
}

std::string ContainerText::finish() {
    text_.append(end_blocks * block, '\0');
    return std::move(text_);
}

}  // namespace taktwerk::runtime
