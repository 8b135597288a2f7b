//! Where a file comes from: program, commit, scene, machine.

use super::Header;
use std::sync::LazyLock;

/// Version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Commit that the program was built from, with a `+` if the sources differed from it;
/// `unknown` if it was built outside a repository.
pub const COMMIT: &str = env!("ESKER_COMMIT");

/// The texts among the global attributes of every file; the seed is a number.
pub(super) fn texts(header: &Header) -> [(&'static str, String); 8] {
    [
        ("title", header.title.clone()),
        ("source", format!("esker {VERSION} ({COMMIT})")),
        ("version", VERSION.into()),
        ("commit", COMMIT.into()),
        ("machine", machine().into()),
        ("backend", header.backend.into()),
        ("device", header.device.clone()),
        ("scene", header.scene.clone()),
    ]
}

/// Processor, cores, memory and system of this machine, without its name.
pub fn machine() -> &'static str {
    static MACHINE: LazyLock<String> = LazyLock::new(|| {
        use sysinfo::{CpuRefreshKind, MemoryRefreshKind, RefreshKind, System};
        let wanted = RefreshKind::nothing()
            .with_cpu(CpuRefreshKind::nothing())
            .with_memory(MemoryRefreshKind::nothing().with_ram());
        let name = System::long_os_version().unwrap_or_else(|_| std::env::consts::OS.into());
        let Ok(system) = System::new_with_specifics(wanted) else {
            return name;
        };
        let cpus = system.cpus();
        let brand = cpus.first().map_or("", |cpu| cpu.brand().trim());
        let memory = system.total_memory() >> 30;
        format!(
            "{brand}, {} logical cores, {memory} GiB, {name}",
            cpus.len()
        )
    });
    &MACHINE
}
