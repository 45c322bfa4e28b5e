#pragma once
// Boost for the rooms of the page's server. Their headers are included by web_server.cpp alone, for Boost is the slowest of all to compile
// (tests/architecture looks at it).

#include <boost/asio.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>

#include "core/clock.hpp"
#include "core/time.hpp"
#include "hmi_bridge/web/json_text.hpp"

namespace taktwerk::hmi::web {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using tcp = asio::ip::tcp;
using local = asio::local::stream_protocol;
using Json = nlohmann::ordered_json;
using namespace std::chrono_literals;

inline Instant now() { return SystemClock{}.now(); }

inline std::string text_of(const Json& json) { return json.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace taktwerk::hmi::web
