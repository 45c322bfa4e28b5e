#include "modbus/line/pseudo_terminal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <stdlib.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>

#include "modbus/line/tty_line.hpp"

namespace taktwerk::modbus {

namespace {

Error error(std::string_view what) {
    return {"serial.pseudo_terminal", "pseudo-terminal", fmt::format("{} failed: {}", what, std::strerror(errno)), ""};
}

}  // namespace

Result<std::unique_ptr<PseudoTerminal>> PseudoTerminal::open(const LineSettings& settings) {
    std::unique_ptr<PseudoTerminal> terminal(new PseudoTerminal);
    terminal->settings_ = settings;
    terminal->master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (terminal->master_ < 0) return error("posix_openpt");
    if (::grantpt(terminal->master_) != 0 || ::unlockpt(terminal->master_) != 0) return error("unlockpt");
    std::array<char, 64> name{};
    if (::ptsname_r(terminal->master_, name.data(), name.size()) != 0) return error("ptsname_r");
    terminal->path_ = name.data();
    terminal->slave_ = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    if (terminal->slave_ < 0) return error("open");
    if (auto raw = set_raw(terminal->slave_, settings, terminal->path_); !raw) return std::move(raw).error();
    return terminal;
}

PseudoTerminal::~PseudoTerminal() {
    if (slave_ >= 0) ::close(slave_);
    if (master_ >= 0) ::close(master_);
}

void PseudoTerminal::step(Instant now) {
    for (auto* station : stations_) station->advance(now);
    if (heard_.size > 0 && now - last_byte_ > settings_.frame_gap()) answer(now);
    for (;;) {
        const auto got = ::read(master_, heard_.bytes.data() + heard_.size, heard_.bytes.size() - heard_.size);
        if (got <= 0) return;
        heard_.size += static_cast<std::size_t>(got);
        last_byte_ = now;
        if (cut_) heard_.size = 0;
        const auto length = frame_length(Direction::request, heard_.span());
        const bool whole = length.known == LengthKnown::yes && heard_.size >= length.bytes;
        if (whole || heard_.size == heard_.bytes.size()) answer(now);
    }
}

void PseudoTerminal::answer(Instant now) {
    for (auto* station : stations_) {
        Frame reply;
        if (!station->hear(heard_.span(), now, reply)) continue;
        // Nobody who asks leaves more than one answer unread: the buffer takes it.
        if (::write(master_, reply.bytes.data(), reply.size) < 0) break;
    }
    heard_.size = 0;
}

}  // namespace taktwerk::modbus
