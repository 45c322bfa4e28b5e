#include "apps/diag/tar.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace taktwerk::apps {
namespace {

constexpr std::size_t block = 512, name_size = 100, prefix_size = 155;

void put(std::string& header, std::size_t at, std::string_view text) {
    std::copy(text.begin(), text.end(), header.begin() + static_cast<std::ptrdiff_t>(at));
}

}  // namespace

// Fields by their offsets: name 0, mode 100, uid 108, gid 116, size 124, mtime 136, chksum 148, typeflag 156, magic 257, version 263, uname 265,
// gname 297, prefix 345.
std::string tar_member(std::string_view path, std::string_view bytes, std::int64_t seconds) {
    std::string header(block, '\0');
    if (path.size() <= name_size) {
        put(header, 0, path);
    } else {
        // The first slash that leaves a name short enough behind it.
        const auto slash = path.find('/', path.size() - name_size - 1);
        const bool splits = slash != std::string_view::npos && slash > 0 && slash <= prefix_size && slash + 1 < path.size();
        put(header, 0, splits ? path.substr(slash + 1) : path.substr(0, name_size));
        if (splits) put(header, 345, path.substr(0, slash));
    }
    put(header, 100, "0000644");
    put(header, 108, "0000000");
    put(header, 116, "0000000");
    put(header, 124, fmt::format("{:011o}", bytes.size()));
    put(header, 136, fmt::format("{:011o}", std::max<std::int64_t>(0, seconds)));
    put(header, 148, "        ");
    header[156] = '0';
    put(header, 257,
        std::string_view("ustar\0"
                         "00",
                         8));
    put(header, 265, "root");
    put(header, 297, "root");
    unsigned sum = 0;
    for (const char c : header) sum += static_cast<unsigned char>(c);
    put(header, 148, fmt::format("{:06o}", sum));
    header[154] = '\0';
    header[155] = ' ';
    header.append(bytes);
    header.append((block - bytes.size() % block) % block, '\0');
    return header;
}

std::string tar_end() { return std::string(2 * block, '\0'); }

}  // namespace taktwerk::apps
