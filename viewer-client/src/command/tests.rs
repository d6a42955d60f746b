//! Laws over every row of every table.

use std::collections::BTreeSet;

use super::*;
use crate::settings::Settings;
use crate::value::Shape;

/// Every example of every form.
fn examples() -> impl Iterator<Item = (&'static Form, Command)> {
    forms().flat_map(|form| (form.examples)().into_iter().map(move |example| (form, example)))
}

#[test]
fn every_command_survives_its_text() {
    for (form, command) in examples() {
        let text = command.to_string();
        assert_eq!(text.parse().as_ref(), Ok(&command), "`{text}`");
        assert!(text.starts_with(form.words), "`{text}` begins with `{}`", form.words);
        assert_eq!(command.form().words, form.words, "`{text}` is of one form only");
    }
    for form in forms() {
        assert!(!(form.examples)().is_empty(), "`{}` has no example", form.words);
    }
}

#[test]
fn no_two_forms_begin_alike() {
    let names: Vec<&str> =
        forms().flat_map(|f| f.aliases.iter().copied().chain([f.words])).collect();
    let distinct: BTreeSet<&str> = names.iter().copied().collect();
    assert_eq!(names.len(), distinct.len(), "{names:?}");
    for form in forms() {
        for alias in form.aliases {
            for example in (form.examples)() {
                let text = example.to_string().replacen(form.words, alias, 1);
                assert_eq!(text.parse(), Ok(example), "`{text}`");
            }
        }
    }
}

#[test]
fn what_help_calls_a_range_is_what_the_parser_takes() {
    let mut count = 0;
    /// Numbers beyond this one are not all told apart by those of ranges.
    const EXACT: f64 = (1_u64 << 53) as f64;
    for form in forms().filter(|form| (form.parameters)().len() == 1) {
        let Some(range) = form.range().filter(|range| range.high < EXACT) else { continue };
        count += 1;
        let is_taken = |value: f64| format!("{} {value}", form.words).parse::<Command>().is_ok();
        assert!(is_taken(range.low) && is_taken(range.high), "{form:?}: {range}");
        let step = 0.01 * (range.high - range.low);
        assert!(!is_taken(range.low - step) && !is_taken(range.high + step), "{form:?}: {range}");
        assert!(!is_taken(f64::NAN), "{form:?}: no number");
        if form.is_setting() {
            assert!(form.help().contains(&range.to_string()), "{}: {range}", form.help());
        }
    }
    assert!(count > 20, "{count} ranges");
}

#[test]
fn what_help_lists_is_what_the_parser_takes() {
    for form in forms() {
        let parameters = (form.parameters)();
        let is_alone = parameters.len() == 1;
        for parameter in parameters {
            let Shape::Choice(words) = parameter.shape else { continue };
            let (text, help) = (form.text(), form.help());
            for word in words {
                assert!(text.contains(&word) || help.contains(&word), "`{text}`, {help}: {word}");
                if is_alone {
                    let text = format!("{} {word}", form.words);
                    assert!(text.parse::<Command>().is_ok(), "`{text}`");
                }
            }
        }
    }
}

#[test]
fn help_is_one_sentence_for_people() {
    for form in forms() {
        let help = form.help();
        assert!(help.starts_with(char::is_uppercase), "{help}");
        assert!(!help.ends_with('.') && !help.contains(['`', '[']), "{help}");
        assert!((5..200).contains(&help.len()), "{help}");
    }
}

/// What is copied as text is all that was set, and leads to it from anywhere.
#[test]
fn settings_survive_their_commands() {
    let usual = Settings::default();
    let copied = |settings: &Settings| -> Settings {
        let mut other = Settings::default();
        for command in settings.commands() {
            let text = command.to_string();
            other.apply(&text.parse().unwrap_or_else(|error| panic!("`{text}`: {error}")));
        }
        other
    };
    assert_eq!(copied(&usual), usual, "the defaults are within their limits");
    for (form, command) in examples().filter(|(form, _)| form.is_setting()) {
        let mut settings = usual.clone();
        settings.apply(&command);
        let again = copied(&settings);
        assert_eq!(again, settings, "{form:?} is lost in what is copied");
    }
    // Each row sets something of its own.
    for form in forms().filter(|form| form.is_setting()) {
        let changes = (form.examples)().into_iter().any(|command| {
            let mut settings = usual.clone();
            settings.apply(&command);
            settings != usual
        });
        assert!(changes, "{form:?} sets nothing");
    }
}

/// Commands as scripts and links have them since before the tables: each must go on to mean the same.
const OLD: &str = "camera orbit 12.5 -3\ncamera pan 0.1 -0.25\ncamera zoom 1.5 0.25 -0.5\n\
    camera look 3 4\ncamera move 0.1 0 -0.2\ncamera fly toggle\ncamera through on\n\
    camera focus 1 2 -3 40\ncamera frame\ncamera place 1 2 -3 40 -12.5 8\ncamera view front\n\
    cloud freeze toggle\ncloud clear\ncloud width 2.5\ncloud opacity 0.5\ncloud hidden 0.1\n\
    cloud fade 500\ncloud shown 2000\ncloud limit 5000\ncloud threshold 10\ncloud budget 64\n\
    cloud color strategy\ncloud ends off\ncloud dots 1.5\ncloud marks ends\ncloud scale log\n\
    cloud blend add\ncloud cue 0.5\ncloud dim 0.25\n\
    scene shading wireframe\nscene opacity 0.25\nscene cutaway off\nscene camera on\n\
    scene grid toggle\nscene light at 1 -2.5 3\nscene light camera\nscene lighting phong\n\
    scene handles scale\nscene clip -x\nscene cut 0.25\n\
    filter set film in rect(0.25, 0, 1, 0.5)\nfilter clear\nfilter enable off\nfilter invert toggle\n\
    filter add start 1 2.5 -3 0.25\nfilter move 1 0 0 1 2\nfilter choose 0\nfilter delete 2\n\
    filter bare\nfilter keep my caustics\nfilter use on my caustics\n\
    filter reverse toggle my caustics\nfilter load my caustics\nfilter forget my caustics\n\
    image exposure -1.5\nimage auto\nimage zoom 2\nimage look 0.25 0.75\nimage fit\n\
    image show difference\nimage channel luminance\nimage tone gamma\nimage gamma 1.8\n\
    image reference a b.exr\nimage forget\nimage save out.png\nimage tev 127.0.0.1:14158\n\
    panel statistics off\nfold image on\narrange filter before image\nwidth left 300\nusual\n\
    mouse blender\ntheme light\ntheme toggle\nhelp toggle\nkeys classic\nseen on\npalette on\n\
    hint off\nscale 125\npath pick 0.1 -0.2 0.01\npath stay 2\npath explored\n\
    path show 3.0.1024 1 7 32 0.5 0.25 0.75 1.5 1 0.5 0 1 2.5 -3 0 32767 0 0 1 4 4 5 6 0 -32768 6 0 0 4294967295\n\
    path none\npath vertex 3\npath vertex next\nplay toggle\nplay rate 0.5\nplay to 7\nplay by -2\n\
    play accepted\nconnect 127.0.0.1:50061\nshare\nscreenshot a b.png\ncopy statistics\n\
    copy status\nexplorer seed 3.0.1024\nexplorer seed newest\nexplorer play 2.5\nexplorer pause\n\
    explorer step 10\nexplorer skip accepted\nexplorer skip 3\nexplorer allow 0,2,5\n\
    explorer allow all\nexplorer fan 2 100\nexplorer show live\nexplorer show 7\nchains pause\n\
    chains resume\nchains weight 1 0.25\nchains precision 0.001\nchains restart 7\nlease ask\n\
    lease release\nlease give 12\nundo\nredo\nreconnect\nquit";

#[test]
fn scripts_of_the_past_still_work() {
    for text in OLD.lines().map(str::trim) {
        let command: Command = text.parse().unwrap_or_else(|error| panic!("`{text}`: {error}"));
        let is_alias = |alias: &&&str| text.starts_with(**alias);
        let alias = command.form().aliases.iter().find(is_alias).unwrap_or(&"");
        let expected = if alias.is_empty() {
            text.to_owned()
        } else {
            text.replacen(*alias, command.form().words, 1)
        };
        assert_eq!(command.to_string(), expected, "text of {command:?}");
    }
}

#[test]
fn mistakes_are_explained() {
    let complaint = |text: &str| text.parse::<Command>().expect_err(text).to_string();
    assert_eq!(complaint(""), "a command is missing");
    assert!(complaint("fly").contains("unknown command `fly`"), "names the word");
    assert!(complaint("cloud widthh 3").contains("did you mean `cloud width PIXELS`"), "guesses");
    assert!(complaint("cloud width").contains("PIXELS is missing"), "names the parameter");
    assert!(complaint("cloud width thin").contains("`thin` is not a number"), "names the word");
    assert!(complaint("cloud width NaN").contains("`NaN` is not a number"), "no NaN");
    assert!(complaint("cloud width 900").contains("between 0.25 and 20"), "names the limits");
    assert!(complaint("chains weight 1 inf").contains("`inf` is not"), "no infinity");
    assert!(complaint("explorer seed 3.4").contains("CHAIN.EPOCH.STEP"), "shows the form");
    assert!(complaint("explorer allow 1,64").contains("numbers"), "no such strategy");
    assert!(complaint("scene grid maybe").contains("on, off, toggle"), "lists the choices");
    assert!(complaint("filter set edges >").contains("cannot be read"), "says what is wrong");
    assert!(complaint("image save").contains("FILE is missing"), "names the parameter");
    assert!(complaint("scale 1000").contains("between 50 and 300"), "names the limits");
    assert!(complaint("quit now").contains("unexpected `now`"), "names the rest");
}
