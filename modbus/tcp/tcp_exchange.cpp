#include "modbus/tcp/tcp_exchange.hpp"

#include <arpa/inet.h>
#include <modbus/modbus.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <string>
#include <utility>

namespace taktwerk::modbus::tcp {

namespace {

using Kind = Fault::Kind;

/// Of a failed call of the system or of libmodbus.
Fault fault_of(int error) noexcept {
    switch (error) {
        case ECONNREFUSED: return {Kind::refused};
        case ETIMEDOUT:
        case EINPROGRESS:
        case EAGAIN: return {Kind::timeout};
        case ECONNRESET:
        case ECONNABORTED:
        case EPIPE:
        case EBADF:
        case ENOTCONN: return {Kind::closed};
        default: break;
    }
    constexpr int last_exception = MODBUS_EXCEPTION_GATEWAY_TARGET;
    if (error >= MODBUS_ENOBASE && error <= MODBUS_ENOBASE + last_exception)
        return {Kind::exception, static_cast<std::uint8_t>(error - MODBUS_ENOBASE)};
    if (error > MODBUS_ENOBASE) return {Kind::bad_answer};
    return {Kind::unreachable};  // EHOSTUNREACH, ENETUNREACH, ENETDOWN, ...
}

struct Address {
    sockaddr_storage bytes{};
    socklen_t length = 0;
};

/// What the system takes for an IPv4 address besides four plain numbers: octal ones with leading zeros, three numbers, one.
bool is_plain(const std::string& host) {
    in_addr four{};
    if (host.find(':') != std::string::npos) return true;
    if (::inet_pton(AF_INET, host.c_str(), &four) != 1) return false;
    const auto address = ntohl(four.s_addr);
    return address != INADDR_ANY && address != INADDR_BROADCAST && !IN_MULTICAST(address);
}

Address address_of(const std::string& host, std::uint16_t port) {
    addrinfo wanted{};
    wanted.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
    wanted.ai_socktype = SOCK_STREAM;
    addrinfo* found = nullptr;
    Address out;
    if (!is_plain(host)) return out;
    if (::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found) != 0 || found == nullptr) return out;
    if (found->ai_addrlen <= sizeof out.bytes) {
        auto* to = reinterpret_cast<char*>(&out.bytes);
        const auto* from = reinterpret_cast<const char*>(found->ai_addr);
        std::copy(from, from + found->ai_addrlen, to);
        out.length = found->ai_addrlen;
    }
    ::freeaddrinfo(found);
    return out;
}

int milliseconds(Duration duration) noexcept { return static_cast<int>(duration / std::chrono::milliseconds{1}); }

/// 0, or what went wrong.
int connect_within(int socket, const Address& address, Duration timeout) {
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&address.bytes), address.length) == 0) return 0;
    if (errno != EINPROGRESS) return errno;
    pollfd ready{socket, POLLOUT, 0};
    const int count = ::poll(&ready, 1, milliseconds(timeout));
    if (count <= 0) return count == 0 || errno == EINTR ? ETIMEDOUT : errno;
    int error = 0;
    socklen_t length = sizeof error;
    return ::getsockopt(socket, SOL_SOCKET, SO_ERROR, &error, &length) == 0 ? error : errno;
}

}  // namespace

struct TcpExchange::Context {
    explicit Context(const DeviceConfig& device) : modbus(::modbus_new_tcp("127.0.0.1", device.port)) {
        if (modbus == nullptr) return;
        const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(device.timeout);
        const auto rest = std::chrono::duration_cast<std::chrono::microseconds>(device.timeout - seconds);
        ::modbus_set_response_timeout(modbus, static_cast<std::uint32_t>(seconds.count()), static_cast<std::uint32_t>(rest.count()));
        ::modbus_set_byte_timeout(modbus, 0, 0);  // else who sends a byte now and then is waited for without end
        ::modbus_set_slave(modbus, device.unit);
    }
    ~Context() { ::modbus_free(modbus); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    modbus_t* modbus;
};

bool is_address(const std::string& host) { return address_of(host, 502).length != 0; }

TcpExchange::TcpExchange(const DeviceConfig& device) : context_(std::make_unique<Context>(device)), device_(device) {}
TcpExchange::~TcpExchange() { TcpExchange::close(); }

Fault TcpExchange::connect() {
    close();
    const auto address = address_of(device_.host, device_.port);
    if (address.length == 0 || context_->modbus == nullptr) return {Kind::unreachable};
    const int socket = ::socket(address.bytes.ss_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket < 0) return fault_of(errno);
    int error = connect_within(socket, address, device_.timeout);
    if (error == 0 && socket >= FD_SETSIZE) error = EMFILE;  // libmodbus waits by select()
    if (error != 0) {
        ::close(socket);
        return fault_of(error);
    }
    const int yes = 1;
    ::setsockopt(socket, IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    ::modbus_set_socket(context_->modbus, socket);
    connected_ = true;
    return {};
}

void TcpExchange::close() {
    if (std::exchange(connected_, false)) ::modbus_close(context_->modbus);
}

Fault TcpExchange::read(Table table, std::uint16_t address, std::span<std::uint16_t> values) {
    if (!connected_) return {Kind::closed};
    const int count = static_cast<int>(values.size());
    auto* modbus = context_->modbus;
    int done = 0;
    if (is_bits(table)) {
        std::array<std::uint8_t, MODBUS_MAX_READ_BITS> bits{};
        done = table == Table::coil ? ::modbus_read_bits(modbus, address, count, bits.data())
                                    : ::modbus_read_input_bits(modbus, address, count, bits.data());
        for (std::size_t i = 0; done == count && i < values.size(); ++i) values[i] = bits[i] != 0 ? 1 : 0;
    } else {
        done = table == Table::holding ? ::modbus_read_registers(modbus, address, count, values.data())
                                       : ::modbus_read_input_registers(modbus, address, count, values.data());
    }
    if (done == count) return {};
    return done < 0 ? fault_of(errno) : Fault{Kind::bad_answer};
}

Fault TcpExchange::write(Table table, std::uint16_t address, std::span<const std::uint16_t> values) {
    if (!connected_) return {Kind::closed};
    const int count = static_cast<int>(values.size());
    auto* modbus = context_->modbus;
    int done = 0;
    if (table == Table::coil) {
        std::array<std::uint8_t, MODBUS_MAX_WRITE_BITS> bits{};
        for (std::size_t i = 0; i < values.size() && i < bits.size(); ++i) bits[i] = values[i] != 0 ? 1 : 0;
        done = count == 1 ? ::modbus_write_bit(modbus, address, bits[0]) : ::modbus_write_bits(modbus, address, count, bits.data());
    } else {
        done = count == 1 ? ::modbus_write_register(modbus, address, values[0])
                          : ::modbus_write_registers(modbus, address, count, values.data());
    }
    if (done == count) return {};
    return done < 0 ? fault_of(errno) : Fault{Kind::bad_answer};
}

}  // namespace taktwerk::modbus::tcp
