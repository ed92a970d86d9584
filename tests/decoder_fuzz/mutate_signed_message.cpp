// One message: changed, and in half of the cases with the right tag.

#include "tests/decoder_fuzz/mutator.hpp"
#include "tests/decoder_fuzz/signed_key.hpp"

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using namespace kintsugi;  // NOLINT(google-build-using-namespace)
  Bytes message = fuzzing::mutated({data, data + size}, max_size);
  const auto parts = signed_message::split(message);
  if (parts && seed % 2 == 0) {
    message = signed_message::sign(fuzzing::signed_key(), fuzzing::kSignedChannel, parts->session,
                                   parts->sequence, parts->message);
  }
  std::copy(message.begin(), message.end(), data);
  return message.size();
}
