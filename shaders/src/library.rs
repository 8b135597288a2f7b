//! The WGSL files and their composition.
//!
//! Every file is a module that is imported by the path it lies at (`#import dem::fixed`),
//! and the scene's choices are flags (`#ifdef LEDGER`): what a scene does not use is not
//! compiled.

use crate::naga::Module;
use crate::{Error, Parts, parts};
use include_dir::{Dir, File, include_dir};
use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue,
    get_preprocessor_data,
};
use std::collections::HashMap;

static COUPLING: Dir = include_dir!("$CARGO_MANIFEST_DIR/coupling");
static DEM: Dir = include_dir!("$CARGO_MANIFEST_DIR/dem");
static LBM: Dir = include_dir!("$CARGO_MANIFEST_DIR/lbm");

/// The choices of a scene, as the preprocessor sees them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flags {
    values: HashMap<String, ShaderDefValue>,
    /// Of the arrays that lie in several.
    parts: HashMap<String, Parts>,
}

impl Flags {
    /// No choice made.
    pub fn new() -> Self {
        Self::default()
    }

    /// With `name`, for `#ifdef name`.
    pub fn set(self, name: &str) -> Self {
        self.set_if(name, true)
    }

    /// With `name` if `is` holds.
    pub fn set_if(mut self, name: &str, is: bool) -> Self {
        if is {
            self.values.insert(name.into(), ShaderDefValue::Bool(true));
        }
        self
    }

    /// With the number `name`, for `#{name}`.
    pub fn number(mut self, name: &str, value: u32) -> Self {
        self.values.insert(name.into(), ShaderDefValue::UInt(value));
        self
    }

    /// For an array `name` that lies in `parts`. Where the WGSL declares it with the note
    /// `// in parts`, it is read and written by `NAME_at(place)` and `set_NAME(place, value)`; in one
    /// part these are `NAME[place]` and nothing else.
    pub fn parts(mut self, name: &str, parts: Parts) -> Self {
        if parts.count > 1 {
            self.parts.insert(name.into(), parts);
        }
        self
    }

    /// With all of `others` too.
    pub fn and(mut self, others: &Self) -> Self {
        self.values.extend(others.values.clone());
        self.parts.extend(others.parts.clone());
        self
    }

    fn expand(&self, text: &str) -> Result<String, Error> {
        parts::expand(text, |name| self.parts.get(name).copied())
    }

    /// Is `name` set?
    pub fn has(&self, name: &str) -> bool {
        self.values.contains_key(name)
    }
}

/// Path and text of every WGSL file, as `dem/step.wgsl`.
pub fn files() -> Vec<(String, &'static str)> {
    let mut found = Vec::new();
    collect("coupling", &COUPLING, &mut found);
    collect("dem", &DEM, &mut found);
    collect("lbm", &LBM, &mut found);
    found.sort_unstable();
    found
}

fn collect(root: &str, dir: &'static Dir, found: &mut Vec<(String, &'static str)>) {
    let text = |file: &'static File| file.contents_utf8().unwrap_or_default();
    let wgsl = dir
        .files()
        .filter(|file| file.path().extension().is_some_and(|e| e == "wgsl"));
    found.extend(wgsl.map(|file| (format!("{root}/{}", file.path().display()), text(file))));
    for dir in dir.dirs() {
        collect(root, dir, found);
    }
}

/// The module of file `path` with all it imports, under `flags`.
///
/// # Errors
/// [`Error::Shader`] with the place and the compiler's words.
pub fn compose(path: &str, flags: &Flags) -> Result<Module, Error> {
    compose_text(path, find(&files(), path)?, flags)
}

/// The module of `text`, called `path` in messages, with all it imports, under `flags`: for
/// kernels that lie elsewhere.
///
/// # Errors
/// As [`compose`].
pub fn compose_text(path: &str, text: &str, flags: &Flags) -> Result<Module, Error> {
    let files = files();
    let mut composer = Composer::default();
    add_imports(&mut composer, &files, text, flags)?;
    let module = composer.make_naga_module(NagaModuleDescriptor {
        source: &flags.expand(text)?,
        file_path: path,
        shader_defs: flags.values.clone(),
        ..Default::default()
    });
    module.map_err(|error| Error::Shader(error.emit_to_string(&composer)))
}

/// A name as the file gives it: composition decorates those of imported items at their end.
pub(crate) fn plain(name: &str) -> &str {
    name.split_once("X_naga_oil_mod_X")
        .map_or(name, |(plain, _)| plain)
}

fn find(files: &[(String, &'static str)], path: &str) -> Result<&'static str, Error> {
    let found = files.iter().find(|(name, _)| name == path);
    let found = found.ok_or_else(|| Error::Shader(format!("there is no {path}")))?;
    Ok(found.1)
}

/// Name and path of the module that `import` names, itself or one item of it.
fn module_of(files: &[(String, &'static str)], import: &str) -> Result<(String, String), Error> {
    let item = import
        .rsplit_once("::")
        .map_or(import, |(module, _)| module);
    for name in [import, item] {
        let path = format!("{}.wgsl", name.replace("::", "/"));
        if find(files, &path).is_ok() {
            return Ok((name.into(), path));
        }
    }
    Err(Error::Shader(format!("no file holds {import}")))
}

/// Add what `text` imports, deepest first.
fn add_imports(
    composer: &mut Composer,
    files: &[(String, &'static str)],
    text: &str,
    flags: &Flags,
) -> Result<(), Error> {
    let (_, imports, _) = get_preprocessor_data(text);
    for import in imports {
        let (name, path) = module_of(files, &import.import)?;
        if composer.contains_module(&name) {
            continue;
        }
        let source = find(files, &path)?;
        add_imports(composer, files, source, flags)?;
        let added = composer.add_composable_module(ComposableModuleDescriptor {
            source: &flags.expand(source)?,
            file_path: &path,
            as_name: Some(name),
            ..Default::default()
        });
        if let Err(error) = added {
            return Err(Error::Shader(error.emit_to_string(composer)));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_missing_module_is_named() {
        let wrong = module_of(&files(), "dem::nowhere::item").unwrap_err();
        assert!(wrong.to_string().contains("dem::nowhere::item"), "{wrong}");
    }
}
