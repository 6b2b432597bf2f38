// The message of an exception that is expected.
#pragma once

#include <exception>
#include <string>

namespace raylanes {

// What the Error that `call` throws says; "no exception" if it throws none. Others pass through.
template <class Error = std::exception, class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no exception";
}

}  // namespace raylanes
