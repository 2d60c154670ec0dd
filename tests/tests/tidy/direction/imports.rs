//! Which file of a crate imports from which, read from its syntax.
//!
//! A file imports from another where a `use` or a path in its code leads into the other's module: through `crate`, `super`,
//! `self`, a child module or a name that a `use` of the same file gave to a module. What only tests compile is left
//! out, and so are `mod` declarations, documentation and visibilities.
//!
//! Limits: an item that a module re-exports counts as that module's. Names that a glob brings in are not followed; the
//! glob itself counts.

use std::collections::{BTreeMap, BTreeSet};

use syn::visit::{self, Visit};

/// Imports between files: who, from whom, and one path that says so.
pub type Imports = BTreeMap<(String, String), String>;

/// The segments of a module's path below the crate's root.
type Module = Vec<String>;

/// One crate's files by module.
struct Crate {
    modules: BTreeMap<Module, String>,
}

impl Crate {
    /// The file that a path leads into: that of its longest beginning that is a module.
    fn file(&self, path: &[String]) -> Option<(usize, &String)> {
        (0..=path.len()).rev().find_map(|n| Some((n, self.modules.get(&path[..n])?)))
    }
}

/// The module of a file, given by its path below `src`.
fn module(file: &str) -> Module {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    if stem == "lib" || stem == "main" { Vec::new() } else { stem.split('/').map(str::to_owned).collect() }
}

/// What the files of one crate, `(path below src, text)`, import from each other.
///
/// # Panics
/// If a text is no Rust.
pub fn imports(files: &[(String, String)]) -> Imports {
    let parsed: Vec<(&String, syn::File)> = files
        .iter()
        .map(|(file, text)| (file, syn::parse_file(text).unwrap_or_else(|error| panic!("{file}: {error}"))))
        .collect();
    let of_tests: BTreeSet<Module> = parsed
        .iter()
        .flat_map(|(file, syntax)| {
            test_modules(&syntax.items).map(|name| [module(file), vec![name]].concat())
        })
        .collect();
    let is_of_tests = |path: &Module| (1..=path.len()).any(|n| of_tests.contains(&path[..n]));
    // Beside a library a `main.rs` is a crate of its own.
    let library = files.iter().any(|(file, _)| file == "lib.rs");
    let counts = |file: &str| !(file.starts_with("bin/") || library && file == "main.rs");
    let mut known = Crate { modules: BTreeMap::new() };
    for (file, _) in parsed.iter().filter(|(file, _)| counts(file)) {
        let path = module(file);
        if !is_of_tests(&path) {
            known.modules.insert(path, (*file).clone());
        }
    }
    let mut found = Imports::new();
    for (file, syntax) in &parsed {
        let path = module(file);
        if known.modules.get(&path) == Some(*file) {
            let mut reader = Reader { known: &known, file, here: path, names: BTreeMap::new(), found };
            // Names first: a path may stand before the `use` that explains it.
            reader.learn(&syntax.items);
            reader.visit_file(syntax);
            found = reader.found;
        }
    }
    found
}

/// Modules with a file of their own that only tests compile.
fn test_modules(items: &[syn::Item]) -> impl Iterator<Item = String> {
    items.iter().filter_map(|item| match item {
        syn::Item::Mod(module) if module.content.is_none() && is_for_tests(&module.attrs) => {
            Some(module.ident.to_string())
        }
        _ => None,
    })
}

/// Whether attributes say `cfg(test)`, by itself or among what has to hold.
fn is_for_tests(attributes: &[syn::Attribute]) -> bool {
    let is_test = |attribute: &syn::Attribute| {
        let syn::Meta::List(list) = &attribute.meta else { return false };
        let condition = list.tokens.to_string().replace(' ', "");
        list.path.is_ident("cfg") && (condition == "test" || condition.starts_with("all(test,"))
    };
    attributes.iter().any(is_test)
}

/// The attributes of an item of a module.
fn attributes(item: &syn::Item) -> &[syn::Attribute] {
    use syn::Item::{Const, Enum, Fn, Impl, Macro, Mod, Static, Struct, Trait, Type, Union, Use};
    match item {
        Const(item) => &item.attrs,
        Enum(item) => &item.attrs,
        Fn(item) => &item.attrs,
        Impl(item) => &item.attrs,
        Macro(item) => &item.attrs,
        Mod(item) => &item.attrs,
        Static(item) => &item.attrs,
        Struct(item) => &item.attrs,
        Trait(item) => &item.attrs,
        Type(item) => &item.attrs,
        Union(item) => &item.attrs,
        Use(item) => &item.attrs,
        _ => &[],
    }
}

/// Every path of a `use`, and the name it goes by.
fn leaves(tree: &syn::UseTree, before: &[String], out: &mut Vec<(Vec<String>, Option<String>)>) {
    let with = |ident: &syn::Ident| [before, &[ident.to_string()]].concat();
    match tree {
        syn::UseTree::Path(path) => leaves(&path.tree, &with(&path.ident), out),
        syn::UseTree::Group(group) => group.items.iter().for_each(|tree| leaves(tree, before, out)),
        syn::UseTree::Glob(_) => out.push((before.to_vec(), None)),
        syn::UseTree::Name(name) if name.ident == "self" => {
            out.push((before.to_vec(), before.last().cloned()))
        }
        syn::UseTree::Name(name) => out.push((with(&name.ident), Some(name.ident.to_string()))),
        syn::UseTree::Rename(name) if name.ident == "self" => {
            out.push((before.to_vec(), Some(name.rename.to_string())));
        }
        syn::UseTree::Rename(name) => out.push((with(&name.ident), Some(name.rename.to_string()))),
    }
}

/// Reads one file.
struct Reader<'a> {
    known: &'a Crate,
    file: &'a str,
    /// The module that is being read: the file's or one written inside it.
    here: Module,
    /// Modules by the names that the file gives them.
    names: BTreeMap<String, Module>,
    found: Imports,
}

impl Reader<'_> {
    /// Learns the names that `use` items give to modules.
    fn learn(&mut self, items: &[syn::Item]) {
        for item in items {
            let syn::Item::Use(item) = item else { continue };
            let mut paths = Vec::new();
            leaves(&item.tree, &[], &mut paths);
            for (path, name) in paths {
                let target = self.absolute(&path).filter(|path| self.known.modules.contains_key(path));
                if let (Some(target), Some(name)) = (target, name) {
                    self.names.insert(name, target);
                }
            }
        }
    }

    /// A path from the crate's root, if it stays in the crate.
    fn absolute(&self, path: &[String]) -> Option<Module> {
        let (first, rest) = path.split_first()?;
        let child = [&*self.here, std::slice::from_ref(first)].concat();
        match first.as_str() {
            "crate" => Some(rest.to_vec()),
            "self" => Some([&*self.here, rest].concat()),
            "super" => {
                let ups = path.iter().take_while(|segment| *segment == "super").count();
                Some([&self.here[..self.here.len().checked_sub(ups)?], &path[ups..]].concat())
            }
            _ if self.known.modules.contains_key(&child) => Some([&child, rest].concat()),
            name => Some([self.names.get(name)?, rest].concat()),
        }
    }

    fn add(&mut self, path: &[String]) {
        let Some(absolute) = self.absolute(path) else { return };
        let Some((_, target)) = self.known.file(&absolute) else { return };
        if target != self.file {
            let edge = (self.file.to_owned(), target.clone());
            self.found.entry(edge).or_insert_with(|| path.join("::"));
        }
    }

    /// Paths among the tokens of a macro's call, which have no syntax of their own.
    fn add_tokens(&mut self, tokens: &str) {
        let words: Vec<&str> = tokens.split_whitespace().collect();
        let is_name = |word: &str| word.starts_with(|c: char| c.is_alphabetic() || c == '_');
        let mut at = 0;
        while at < words.len() {
            let mut path = Vec::new();
            while words.get(at).is_some_and(|word| is_name(word)) {
                path.push(words[at].to_owned());
                at += 1;
                if words.get(at) != Some(&"::") {
                    break;
                }
                at += 1;
            }
            if path.len() > 1 {
                self.add(&path);
            }
            at += usize::from(path.is_empty());
        }
    }
}

impl<'ast> Visit<'ast> for Reader<'_> {
    fn visit_item(&mut self, item: &'ast syn::Item) {
        if !is_for_tests(attributes(item)) {
            visit::visit_item(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_for_tests(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_item_mod(&mut self, module: &'ast syn::ItemMod) {
        self.here.push(module.ident.to_string());
        visit::visit_item_mod(self, module);
        self.here.pop();
    }

    fn visit_item_use(&mut self, item: &'ast syn::ItemUse) {
        let mut paths = Vec::new();
        leaves(&item.tree, &[], &mut paths);
        paths.iter().for_each(|(path, _)| self.add(path));
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        if path.segments.len() > 1 {
            self.add(&path.segments.iter().map(|segment| segment.ident.to_string()).collect::<Vec<_>>());
        }
        visit::visit_path(self, path);
    }

    fn visit_macro(&mut self, call: &'ast syn::Macro) {
        self.visit_path(&call.path);
        // Spread out, so that every token is a word.
        let is_of_path = |c: char| c.is_alphanumeric() || c == '_' || c == ':';
        let spread = |c: char| if is_of_path(c) { c.to_string() } else { format!(" {c} ") };
        self.add_tokens(&call.tokens.to_string().chars().map(spread).collect::<String>());
    }

    // What neither imports nor calls: attributes and visibilities.
    fn visit_attribute(&mut self, _: &'ast syn::Attribute) {}
    fn visit_visibility(&mut self, _: &'ast syn::Visibility) {}
}
