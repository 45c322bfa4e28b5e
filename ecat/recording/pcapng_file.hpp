#pragma once
// Frames as a pcapng file, which Wireshark and tshark read: nanoseconds, the side each frame went, and remarks of people's concern on the file
// and on single frames. Not real-time.
//
// Source: draft-ietf-opsawg-pcapng (section header, interface description, enhanced packet; options comment, if_name, if_tsresol, epb_flags).

#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/result.hpp"
#include "core/time.hpp"

namespace taktwerk::ecat {

class PcapngFile {
public:
    struct Head {
        std::string interface;  ///< "eth1"; may be empty
        std::string comment;    ///< on the whole file; may be empty
        Duration epoch{};       ///< calendar time (since 1970) at machine time 0; zero in virtual time
    };
    /// Errors: capture.write, here and below: what cannot be written once, is not tried again.
    [[nodiscard]] static Result<std::unique_ptr<PcapngFile>> create(const std::string& path, const Head& head);

    /// `comment`: on this frame; may be empty.
    Result<void> packet(std::span<const std::byte> frame, Instant at, bool outgoing, std::string_view comment = {});
    /// Everything is with the operating system. Gives the error of an earlier call, too.
    Result<void> finish();

    [[nodiscard]] std::uint64_t packets() const noexcept { return packets_; }

private:
    struct Close {
        void operator()(std::FILE* file) const noexcept { std::fclose(file); }
    };
    PcapngFile(std::string path, Duration epoch, std::FILE* file) : path_(std::move(path)), epoch_(epoch), file_(file) {}
    Result<void> put(std::span<const std::byte> block);

    std::string path_;
    Duration epoch_;
    std::unique_ptr<std::FILE, Close> file_;
    std::uint64_t packets_ = 0;
    std::optional<Error> broken_;
};

}  // namespace taktwerk::ecat
