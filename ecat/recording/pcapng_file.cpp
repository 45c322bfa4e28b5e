#include "ecat/recording/pcapng_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <vector>

#include "core/bytes.hpp"

namespace taktwerk::ecat {

namespace {

constexpr std::uint32_t section_header = 0x0A0D0D0A, interface_description = 1, enhanced_packet = 6, byte_order = 0x1A2B3C4D;
constexpr std::uint16_t end_of_options = 0, comment_option = 1, interface_name = 2, packet_flags = 2, application = 4, time_resolution = 9;
constexpr std::uint16_t ethernet = 1;
constexpr std::uint32_t inbound = 1, outbound = 2;

Error failure(const std::string& path) {
    return Error{"capture.write", path, fmt::format("the frames cannot be written: {}", std::strerror(errno)),
                 "choose another place for the capture"};
}

/// A block under construction: type, its own length at both ends, and everything in it on 32-bit bounds.
class Block {
public:
    explicit Block(std::uint32_t type) { add(type), add(std::uint32_t{0}); }

    template <class T>
    void add(T value) {
        const auto at = bytes_.size();
        bytes_.resize(at + sizeof value);
        store_le(std::span{bytes_}, at, value);
    }
    void add(std::span<const std::byte> bytes) {
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        bytes_.resize((bytes_.size() + 3) / 4 * 4);
    }
    void option(std::uint16_t code, std::span<const std::byte> value) {
        add(code);
        add(static_cast<std::uint16_t>(value.size()));
        add(value);
    }
    void option(std::uint16_t code, std::string_view text) {
        constexpr std::size_t longest = 0xFFFC;
        if (!text.empty()) option(code, std::as_bytes(std::span{text.substr(0, longest)}));
    }
    [[nodiscard]] std::span<const std::byte> finished() {
        add(end_of_options), add(std::uint16_t{0});
        const auto length = static_cast<std::uint32_t>(bytes_.size() + sizeof(std::uint32_t));
        add(length);
        store_le(std::span{bytes_}, 4, length);
        return bytes_;
    }

private:
    std::vector<std::byte> bytes_;
};

}  // namespace

Result<std::unique_ptr<PcapngFile>> PcapngFile::create(const std::string& path, const Head& head) {
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return failure(path);
    std::unique_ptr<PcapngFile> result{new PcapngFile{path, head.epoch, file}};
    Block section{section_header};
    section.add(byte_order);
    section.add(std::uint16_t{1});  // version 1.0
    section.add(std::uint16_t{0});
    section.add(~std::uint64_t{0});  // as long as it is
    section.option(comment_option, head.comment);
    section.option(application, "taktwerk");
    if (auto ok = result->put(section.finished()); !ok) return ok.error();
    Block interface { interface_description };
    interface.add(ethernet);
    interface.add(std::uint16_t{0});
    interface.add(std::uint32_t{0});  // no frame is cut
    interface.option(interface_name, head.interface);
    interface.option(time_resolution, std::array{std::byte{9}});  // 10^-9 s
    if (auto ok = result->put(interface.finished()); !ok) return ok.error();
    return result;
}

Result<void> PcapngFile::packet(std::span<const std::byte> frame, Instant at, bool outgoing, std::string_view comment) {
    const auto time = static_cast<std::uint64_t>((at.time_since_epoch() + epoch_).count());
    Block block{enhanced_packet};
    block.add(std::uint32_t{0});  // the one interface
    block.add(static_cast<std::uint32_t>(time >> 32));
    block.add(static_cast<std::uint32_t>(time));
    block.add(static_cast<std::uint32_t>(frame.size()));
    block.add(static_cast<std::uint32_t>(frame.size()));
    block.add(frame);
    std::array<std::byte, 4> flags{};
    store_le(std::span{flags}, 0, outgoing ? outbound : inbound);
    block.option(packet_flags, flags);
    block.option(comment_option, comment);
    auto ok = put(block.finished());
    if (ok) ++packets_;
    return ok;
}

Result<void> PcapngFile::put(std::span<const std::byte> block) {
    if (!broken_ && std::fwrite(block.data(), block.size(), 1, file_.get()) != 1) broken_ = failure(path_);
    if (broken_) return *broken_;
    return {};
}

Result<void> PcapngFile::finish() {
    if (!broken_ && std::fflush(file_.get()) != 0) broken_ = failure(path_);
    if (broken_) return *broken_;
    return {};
}

}  // namespace taktwerk::ecat
