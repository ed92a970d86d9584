#pragma once
// spdlog, for every source that logs. A call such as spdlog::info(format, values...) instantiates
// all of fmt's formatting, which takes the compiler 3 s in each source; fmt's library holds that,
// too.

#include <fmt/format.h>
#include <spdlog/spdlog.h>  // IWYU pragma: export

#if FMT_VERSION < 100000  // newer ones say so themselves
extern template void fmt::detail::vformat_to<char>(
    fmt::detail::buffer<char>&, fmt::basic_string_view<char>,
    fmt::basic_format_args<fmt::buffer_context<char>>, fmt::detail::locale_ref);
#endif
