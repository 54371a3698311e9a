// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
/* Preloaded into a program, it makes the n-th of its system calls on files of a folder fail, or the process end there,
 * or writes all of them down. The kernel hands every such call over (seccomp, SIGSYS), whichever library made it: the C
 * library's own streams are seen too. x86-64 and Linux alone.
 *
 *   FAULT_ROOT   the folder; calls on other files pass
 *   FAULT_OPS    which calls count: write, fsync, rename, open, read, unlink, mkdir, lock, by commas
 *   FAULT_AT     the number of the call, from 1; 0: none
 *   FAULT_DO     kill, a signal's number as "signal:15", an errno as "errno:28", or "short": a write of half the bytes
 *   FAULT_ON     "": that call alone; "on": that one and all that follow (a disk that stays full)
 *   FAULT_COUNT  a file of 80 bytes that holds what was counted so far, also after a kill: the calls, the allocations,
 *                and the calls of each kind in the order of FAULT_OPS
 *   FAULT_LOG    a file that gets a line for every call: "write PATH BYTES", "rename PATH PATH", "fsync PATH", ...
 *   FAULT_ALLOC  the number of the allocation that fails, counted from the first in the program's own code; 0: none
 */
#define _GNU_SOURCE
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <malloc.h>
#include <signal.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <ucontext.h>
#include <unistd.h>

#define MAGIC 0x7a1f5a17u /* sixth argument of the calls that the shim makes itself; none of them has so many */

enum Op { op_none, op_write, op_fsync, op_rename, op_open, op_read, op_unlink, op_mkdir, op_lock, op_count };
static const char* const op_names[op_count] = {"",     "write",  "fsync", "rename", "open",
                                               "read", "unlink", "mkdir", "lock"};

static char root[4096];
static size_t root_length;
static int counts_op[op_count];
static long fault_at, fault_errno, fault_signal;
static int fault_kill, fault_short, fault_on;
static int log_file = -1;
static _Atomic int64_t own_counters[1 + op_count];
static _Atomic int64_t* counters = own_counters; /* calls, allocations, calls of each kind */
static long alloc_at;

static long raw(long number, long a, long b, long c, long d, long e) {
  register long r10 __asm__("r10") = d;
  register long r8 __asm__("r8") = e;
  register long r9 __asm__("r9") = MAGIC;
  long result;
  __asm__ volatile("syscall"
                   : "=a"(result)
                   : "a"(number), "D"(a), "S"(b), "d"(c), "r"(r10), "r"(r8), "r"(r9)
                   : "rcx", "r11", "memory");
  return result;
}

static void append(char* line, size_t* length, const char* text) {
  const size_t more = strlen(text);
  if (*length + more + 2 >= 9000) return;
  memcpy(line + *length, text, more);
  *length += more;
  line[*length] = 0;
}

static void append_number(char* line, size_t* length, long value) {
  char digits[24];
  size_t at = sizeof digits;
  digits[--at] = 0;
  do digits[--at] = (char)('0' + value % 10);
  while ((value /= 10) > 0);
  append(line, length, digits + at);
}

static int below_root(const char* path) { return strncmp(path, root, root_length) == 0; }

/* The path of a descriptor; 0 where it is none of the folder. */
static int path_of(long descriptor, char* path, size_t size) {
  char link[40] = "/proc/self/fd/";
  size_t length = strlen(link);
  if (descriptor < 0) return 0;
  append_number(link, &length, descriptor);
  const long got = raw(SYS_readlinkat, AT_FDCWD, (long)link, (long)path, (long)size - 1, 0);
  if (got <= 0) return 0;
  path[got] = 0;
  return below_root(path);
}

static enum Op op_of(long number, const long* a) {
  switch (number) {
    case SYS_write:
    case SYS_writev:
    case SYS_pwrite64:
    case SYS_pwritev:
    case SYS_ftruncate: return op_write;
    case SYS_fsync:
    case SYS_fdatasync: return op_fsync;
    case SYS_rename:
    case SYS_renameat:
    case SYS_renameat2: return op_rename;
    case SYS_open: return a[1] & (O_CREAT | O_WRONLY | O_RDWR) ? op_open : op_none;
    case SYS_openat: return a[2] & (O_CREAT | O_WRONLY | O_RDWR) ? op_open : op_none;
    case SYS_read:
    case SYS_pread64:
    case SYS_readv: return op_read;
    case SYS_unlink:
    case SYS_unlinkat:
    case SYS_rmdir: return op_unlink;
    case SYS_mkdir:
    case SYS_mkdirat: return op_mkdir;
    case SYS_flock: return op_lock;
    default: return op_none;
  }
}

/* The path that a call is about, and the second one of a rename; 0 where it is none of the folder. */
static int subject(long number, const long* a, char* path, size_t size, const char** second) {
  const char* name = NULL;
  *second = NULL;
  switch (number) {
    case SYS_rename: name = (const char*)a[0], *second = (const char*)a[1]; break;
    case SYS_renameat:
    case SYS_renameat2: name = (const char*)a[1], *second = (const char*)a[3]; break;
    case SYS_open:
    case SYS_unlink:
    case SYS_rmdir:
    case SYS_mkdir: name = (const char*)a[0]; break;
    case SYS_openat:
    case SYS_unlinkat:
    case SYS_mkdirat: name = (const char*)a[1]; break;
    default: return path_of(a[0], path, size);
  }
  size_t length = 0;
  path[0] = 0;
  if (name[0] != '/') { /* below an open folder (std::filesystem::remove_all), or where the process stands */
    const long folder = number == SYS_openat || number == SYS_unlinkat || number == SYS_mkdirat ? a[0] : AT_FDCWD;
    if (folder != AT_FDCWD) {
      path_of(folder, path, size);
    } else if (raw(SYS_getcwd, (long)path, (long)size, 0, 0, 0) <= 0) {
      return 0;
    }
    length = strlen(path);
    append(path, &length, "/");
  }
  append(path, &length, name);
  return below_root(path);
}

static void write_down(enum Op op, const char* path, const char* second, long bytes) {
  if (log_file < 0) return;
  char line[9100];
  size_t length = 0;
  append(line, &length, op_names[op]);
  append(line, &length, "\t");
  append(line, &length, path);
  append(line, &length, "\t");
  if (second != NULL) append(line, &length, second);
  if (second == NULL) append_number(line, &length, bytes < 0 ? 0 : bytes);
  append(line, &length, "\n");
  raw(SYS_write, log_file, (long)line, (long)length, 0, 0);
}

static long half_a_write(long number, const long* a) {
  if ((number == SYS_write || number == SYS_pwrite64) && a[2] > 1) return raw(number, a[0], a[1], a[2] / 2, a[3], 0);
  return raw(number, a[0], a[1], a[2], a[3], a[4]);
}

static long answer(long number, const long* a) {
  char path[9100];
  const char* second = NULL;
  const enum Op op = op_of(number, a);
  if (op == op_none || !counts_op[op] || !subject(number, a, path, sizeof path / 2, &second))
    return raw(number, a[0], a[1], a[2], a[3], a[4]);
  const int64_t now = atomic_fetch_add(&counters[0], 1) + 1;
  atomic_fetch_add(&counters[1 + op], 1);
  const int hit = fault_at > 0 && (now == fault_at || (fault_on && now > fault_at));
  if (hit && fault_kill) raw(SYS_kill, raw(SYS_getpid, 0, 0, 0, 0, 0), SIGKILL, 0, 0, 0);
  if (hit && fault_signal > 0) raw(SYS_kill, raw(SYS_getpid, 0, 0, 0, 0, 0), fault_signal, 0, 0, 0);
  if (hit && fault_errno > 0) return -fault_errno;
  const long result = hit && fault_short ? half_a_write(number, a) : raw(number, a[0], a[1], a[2], a[3], a[4]);
  if (result >= 0) write_down(op, path, second, op == op_write || op == op_read ? result : 0);
  return result;
}

static void on_call(int number, siginfo_t* info, void* context) {
  (void)number;
  greg_t* registers = ((ucontext_t*)context)->uc_mcontext.gregs;
  const long arguments[5] = {registers[REG_RDI], registers[REG_RSI], registers[REG_RDX], registers[REG_R10],
                             registers[REG_R8]};
  registers[REG_RAX] = answer(info->si_syscall, arguments);
}

/* The kernel hands over the calls of `numbers` that do not bear the shim's own mark. */
static void watch(const long* numbers, size_t count) {
  struct sock_filter filter[64];
  unsigned short at = 0;
  filter[at++] =
      (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)offsetof(struct seccomp_data, args[5]));
  filter[at++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, MAGIC, 0, 1);
  filter[at++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  filter[at++] = (struct sock_filter)BPF_STMT(BPF_LD | BPF_W | BPF_ABS, (uint32_t)offsetof(struct seccomp_data, nr));
  for (size_t i = 0; i < count; ++i) {
    filter[at++] = (struct sock_filter)BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, (uint32_t)numbers[i], 0, 1);
    filter[at++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP);
  }
  filter[at++] = (struct sock_filter)BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);
  struct sock_fprog program = {at, filter};
  struct sigaction action = {0};
  action.sa_sigaction = on_call;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  sigaction(SIGSYS, &action, NULL);
  if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_TSYNC, &program) != 0)
    _exit(96); /* the driver of the tests takes it for "not to be had here" */
}

static void read_wishes(void) {
  const char* ops = getenv("FAULT_OPS");
  for (int op = 1; op < op_count; ++op) counts_op[op] = ops != NULL && strstr(ops, op_names[op]) != NULL;
  const char* at = getenv("FAULT_AT");
  fault_at = at != NULL ? atol(at) : 0;
  const char* what = getenv("FAULT_DO");
  if (what != NULL && strcmp(what, "kill") == 0) fault_kill = 1;
  if (what != NULL && strcmp(what, "short") == 0) fault_short = 1;
  if (what != NULL && strncmp(what, "errno:", 6) == 0) fault_errno = atol(what + 6);
  if (what != NULL && strncmp(what, "signal:", 7) == 0) fault_signal = atol(what + 7);
  const char* on = getenv("FAULT_ON");
  fault_on = on != NULL && *on != 0;
}

static void open_files(void) {
  const char* count = getenv("FAULT_COUNT");
  if (count != NULL) {
    const int file = open(count, O_RDWR | O_CLOEXEC);
    void* shared = file < 0 ? MAP_FAILED : mmap(NULL, sizeof own_counters, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
    if (shared != MAP_FAILED) counters = shared;
  }
  const char* log = getenv("FAULT_LOG");
  if (log != NULL) log_file = open(log, O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
}

__attribute__((constructor)) static void begin(void) {
  const char* folder = getenv("FAULT_ROOT");
  if (folder == NULL || strlen(folder) + 2 > sizeof root) return;
  strcpy(root, folder);
  root_length = strlen(root);
  read_wishes();
  open_files();
  static const long all[] = {SYS_write,     SYS_writev,  SYS_pwrite64, SYS_pwritev,   SYS_ftruncate, SYS_fsync,
                             SYS_fdatasync, SYS_rename,  SYS_renameat, SYS_renameat2, SYS_open,      SYS_openat,
                             SYS_read,      SYS_pread64, SYS_readv,    SYS_unlink,    SYS_unlinkat,  SYS_rmdir,
                             SYS_mkdir,     SYS_mkdirat, SYS_flock};
  long wanted[sizeof all / sizeof all[0]];
  size_t count = 0;
  for (size_t i = 0; i < sizeof all / sizeof all[0]; ++i) {
    const long flags[5] = {0, O_CREAT, O_CREAT, 0, 0};
    if (counts_op[op_of(all[i], flags)]) wanted[count++] = all[i];
  }
  /* A thread that ends gives memory back, for which the C library opens a file while all signals are blocked: a call
   * that cannot be handed over ends the process. */
  mallopt(M_TRIM_THRESHOLD, INT_MAX);
  if (count > 0) watch(wanted, count);
  const char* allocation = getenv("FAULT_ALLOC");
  if (allocation != NULL) alloc_at = atol(allocation);
}

/* Allocations. Those before the constructor, of the loader and of libraries that set themselves up, do not count. */
extern void* __libc_malloc(size_t);
extern void* __libc_calloc(size_t, size_t);
extern void* __libc_realloc(void*, size_t);
extern void* __libc_memalign(size_t, size_t);

static int refused(void) {
  if (alloc_at == 0) return 0;
  if (atomic_fetch_add(&counters[1], 1) + 1 != alloc_at) return 0;
  errno = ENOMEM;
  return 1;
}

void* malloc(size_t size) { return refused() ? NULL : __libc_malloc(size); }
void* calloc(size_t count, size_t size) { return refused() ? NULL : __libc_calloc(count, size); }
void* realloc(void* old, size_t size) { return refused() ? NULL : __libc_realloc(old, size); }
void* aligned_alloc(size_t alignment, size_t size) { return refused() ? NULL : __libc_memalign(alignment, size); }
void* memalign(size_t alignment, size_t size) { return refused() ? NULL : __libc_memalign(alignment, size); }
int posix_memalign(void** out, size_t alignment, size_t size) {
  if (refused()) return ENOMEM;
  *out = __libc_memalign(alignment, size);
  return *out == NULL ? ENOMEM : 0;
}
