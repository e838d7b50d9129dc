#include "plugins/crash.hpp"

#include <signal.h>
#include <string.h>
#include <unistd.h>

#include <initializer_list>

namespace bodeflow {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitizerTells = true;
#else
constexpr bool kSanitizerTells = false;
#endif

thread_local const AtWork* at_work = nullptr;

void say(const char* text) {
  if (text != nullptr && write(STDERR_FILENO, text, strlen(text)) < 0) return;  // nobody is left to tell
}

/// Calls only what a signal handler may call. The signal's own action comes back: the process dies of it.
void on_crash(int number) {
  const AtWork::Block block = AtWork::block();
  say("\nerror: crashed (");
  say(sigdescr_np(number));
  say(")");
  if (block.name != nullptr) {
    say(" in block '");
    say(block.name);
    say("' (");
    say(block.type);
    say(")");
  }
  say("\n");
  raise(number);
}

}  // namespace

AtWork::AtWork(Where where, const void* what) : where_(where), what_(what), before_(at_work) { at_work = this; }
AtWork::~AtWork() { at_work = before_; }

AtWork::Block AtWork::block() { return at_work == nullptr ? Block{} : at_work->where_(at_work->what_); }

void tell_crashes() {
  if (kSanitizerTells) return;
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) (void)sigaction(number, &action, nullptr);
}

}  // namespace bodeflow
