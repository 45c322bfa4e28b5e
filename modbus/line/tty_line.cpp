#include "modbus/line/tty_line.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace taktwerk::modbus {

namespace {

constexpr Duration reopen_interval = std::chrono::seconds{1};
constexpr std::size_t longest_discard = 256;

/// The rates of the XP200 (manual 9.2, Pr182) and those of its neighbours.
constexpr std::array<std::pair<std::uint32_t, speed_t>, 6> speeds{
    {{4800, B4800}, {9600, B9600}, {19200, B19200}, {38400, B38400}, {57600, B57600}, {115200, B115200}}};

/// The kernel's pseudo-terminals carry bytes, not bits: they have no parity and refuse to be told of one.
bool is_pseudo_terminal(int descriptor) noexcept {
    struct stat about {};
    constexpr unsigned first_major = 136, last_major = 143;  // /dev/pts, Documentation/admin-guide/devices.txt
    return ::fstat(descriptor, &about) == 0 && major(about.st_rdev) >= first_major && major(about.st_rdev) <= last_major;
}

Error error(const char* code, const std::string& device, std::string what, std::string remedy) {
    return {code, fmt::format("serial line {}", device), std::move(what), std::move(remedy)};
}

}  // namespace

Result<void> set_raw(int descriptor, const LineSettings& settings, const std::string& device) {
    speed_t speed = 0;
    for (const auto& [baud, value] : speeds)
        if (baud == settings.baud) speed = value;
    if (speed == 0)
        return error("serial.settings", device, fmt::format("{} baud is no rate of a serial port here", settings.baud),
                     "use 4800, 9600, 19200 or 38400");
    termios terminal{};
    if (::tcgetattr(descriptor, &terminal) != 0)
        return error("serial.settings", device, fmt::format("it is no serial port: {}", std::strerror(errno)), "name a tty");
    ::cfmakeraw(&terminal);
    terminal.c_cflag |= CREAD | CLOCAL;
    terminal.c_cflag &= ~static_cast<tcflag_t>(PARENB | PARODD | CSTOPB | CRTSCTS);
    const bool has_parity = settings.parity != Parity::none && !is_pseudo_terminal(descriptor);
    if (has_parity) terminal.c_cflag |= PARENB;
    if (has_parity && settings.parity == Parity::odd) terminal.c_cflag |= PARODD;
    if (settings.stop_bits == 2) terminal.c_cflag |= CSTOPB;
    terminal.c_cc[VMIN] = 0;
    terminal.c_cc[VTIME] = 0;
    if (::cfsetispeed(&terminal, speed) != 0 || ::cfsetospeed(&terminal, speed) != 0 || ::tcsetattr(descriptor, TCSANOW, &terminal) != 0)
        return error("serial.settings", device, fmt::format("it does not take {} baud: {}", settings.baud, std::strerror(errno)),
                     "choose a rate that the adapter has");
    return {};
}

Result<std::unique_ptr<TtyLine>> TtyLine::open(std::string device, const LineSettings& settings) {
    std::unique_ptr<TtyLine> line(new TtyLine(std::move(device), settings));
    if (auto opened = line->open_now(); !opened) return std::move(opened).error();
    return line;
}

TtyLine::~TtyLine() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

Result<void> TtyLine::open_now() {
    const int descriptor = ::open(device_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0)
        return error(
            "serial.open", device_, fmt::format("cannot be opened: {}", std::strerror(errno)),
            errno == EACCES ? "let the user of the runtime into the group `dialout`" : "check the name of the port and its adapter");
    // Two masters on one line talk into each other's answers.
    (void)::ioctl(descriptor, TIOCEXCL);
    if (auto ok = set_raw(descriptor, settings_, device_); !ok) {
        ::close(descriptor);
        return ok;
    }
    descriptor_ = descriptor;
    return {};
}

void TtyLine::failed(Instant now) noexcept {
    ::close(descriptor_);
    descriptor_ = -1;
    try_again_ = now + reopen_interval;
}

void TtyLine::reopen(Instant now) {
    if (descriptor_ >= 0 || now < try_again_) return;
    try_again_ = now + reopen_interval;
    (void)open_now().ok();  // who asks sees present()
}

bool TtyLine::send(std::span<const std::byte> frame, Instant now) {
    reopen(now);
    if (descriptor_ < 0) return false;
    // A frame is far shorter than the kernel's buffer: what does not fit at once means that nothing drains it.
    const auto written = ::write(descriptor_, frame.data(), frame.size());
    if (written == static_cast<ssize_t>(frame.size())) return true;
    if (written < 0 && errno != EAGAIN && errno != EINTR) failed(now);
    return false;
}

std::size_t TtyLine::receive(std::span<std::byte> into, Instant now) {
    reopen(now);
    if (descriptor_ < 0) return 0;
    const auto got = ::read(descriptor_, into.data(), into.size());
    if (got > 0) return static_cast<std::size_t>(got);
    if (got < 0 && errno != EAGAIN && errno != EINTR) failed(now);
    return 0;
}

void TtyLine::discard(Instant now) {
    std::array<std::byte, longest_discard> scrap;
    while (receive(scrap, now) > 0) {}
}

}  // namespace taktwerk::modbus
